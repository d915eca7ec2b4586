#pragma once
// How far means of few samples lie from what they are means of.

namespace pitviper {

/// t below which Student's distribution of so many degrees of freedom (1 or more, whole or not) has a share p, 1/2 <= p < 1. By its integral over the angle
/// whose tangent is t / root of the degrees: relative error below 1e-8 (tests/unit/test_solve.cpp). Source: Student 1908; Abramowitz and Stegun 26.7.
double studentQuantile(double p, double degrees);

}  // namespace pitviper
