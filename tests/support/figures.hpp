#pragma once
// Measured figures beside what they should be: checked, printed as a table at the end, and kept as <build>/figures_<test>.md.
#include <string>

namespace pitviper::test {

/// Fails the running test unless |measured - expected| <= tolerance |expected|. `source` says what the closed form is and where the
/// remaining error comes from.
void figure(const std::string& what, double measured, double expected, double tolerance, const std::string& source);

/// A bound: fails unless measured <= limit.
void bound(const std::string& what, double measured, double limit, const std::string& source);

}  // namespace pitviper::test
