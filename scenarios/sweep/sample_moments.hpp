#pragma once
// Figures of a list of numbers: quantiles, ranks and how two lists go together.
#include <vector>

namespace pitviper {

/// Of numbers in rising order, linear between neighbours (type 7 of Hyndman and Fan, Am. Stat. 50, 361 (1996)); `part` from 0 to 1. NaN of none.
double quantileOf(const std::vector<double>& rising, double part);

/// From 1; equal numbers have the mean of their ranks.
std::vector<double> ranksOf(const std::vector<double>& values);

/// Spearman's rank correlation of two lists without NaN, of one length; ties have their mean rank. NaN where either does not vary.
double rankCorrelation(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace pitviper
