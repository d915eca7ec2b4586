#include "tests/support/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

namespace pitviper::test {
namespace {

struct Row {
  std::string what, source;
  double measured, expected, error, tolerance;
  bool isBound;
};

class Table : public ::testing::Environment {
 public:
  static std::vector<Row>& rows() {
    static std::vector<Row> all;
    return all;
  }
  void TearDown() override {
    if (rows().empty()) return;
    std::string text = "| figure | measured | expected | error | allowed | source |\n|---|---|---|---|---|---|\n";
    for (const auto& r : rows()) {
      char line[1024];
      if (r.isBound) std::snprintf(line, sizeof line, "| %s | %.3g | at most %.3g | | | %s |\n", r.what.c_str(), r.measured, r.expected, r.source.c_str());
      else
        std::snprintf(line, sizeof line, "| %s | %.7g | %.7g | %.2e | %.0e | %s |\n", r.what.c_str(), r.measured, r.expected, r.error, r.tolerance,
                      r.source.c_str());
      text += line;
    }
    std::printf("\n%s\n", text.c_str());
    const std::string program = ::testing::internal::GetArgvs().empty() ? "test" : ::testing::internal::GetArgvs()[0];
    std::string name = program.substr(program.find_last_of('/') + 1);
    // Each of a kind's pieces has the rows of its own tests; `pitviper test` puts them together.
    if (const char* piece = std::getenv("PITVIPER_PIECE")) name = std::string("test_") + piece;
    if (::testing::GTEST_FLAG(filter) == "*") std::ofstream(std::string(PITVIPER_FIGURES_DIR) + "/figures_" + name + ".md") << text;
  }
};

const auto* const registered = ::testing::AddGlobalTestEnvironment(new Table);

}  // namespace

void figure(const std::string& what, double measured, double expected, double tolerance, const std::string& source) {
  const double error = expected != 0.0 ? std::abs(measured - expected) / std::abs(expected) : std::abs(measured);
  EXPECT_LE(error, tolerance) << what << ": measured " << measured << ", expected " << expected;
  EXPECT_TRUE(std::isfinite(measured)) << what;
  Table::rows().push_back({what, source, measured, expected, error, tolerance, false});
}

void bound(const std::string& what, double measured, double limit, const std::string& source) {
  EXPECT_LE(measured, limit) << what;
  Table::rows().push_back({what, source, measured, limit, 0.0, 0.0, true});
}

}  // namespace pitviper::test
