// The module's border: one C function, no exceptions out.
#include <exception>
#include <thread>

#include "scenarios/commands/charts/charts_module.hpp"
#include "scenarios/commands/charts/sheet.hpp"

extern "C" __attribute__((visibility("default"))) void pitviperDrawCharts(const std::vector<pitviper::Chart>* charts, int columns,
                                                                          pitviper::ChartsReply* reply) {
  // A context is current on one thread: on a thread of its own ours does not take the place of the caller's.
  try {
    std::thread([&] {
      try {
        reply->picture = pitviper::drawSheet(*charts, columns);
      } catch (const std::exception& problem) {
        reply->failure = problem.what();
      }
    }).join();
  } catch (const std::exception& problem) {
    reply->failure = problem.what();
  }
}
