// The module's border: C functions, no exceptions out.
#include <exception>
#include <functional>
#include <thread>

#include "scenarios/commands/charts/charts_module.hpp"
#include "scenarios/commands/charts/sheet.hpp"
#include "scenarios/commands/charts/trajectory_sheet.hpp"

namespace {

/// A context is current on one thread: on a thread of its own ours does not take the place of the caller's.
void answer(pitviper::ChartsReply& reply, const std::function<pitviper::Rgb8Image()>& draw) {
  try {
    std::thread([&] {
      try {
        reply.picture = draw();
      } catch (const std::exception& problem) {
        reply.failure = problem.what();
      }
    }).join();
  } catch (const std::exception& problem) {
    reply.failure = problem.what();
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void pitviperDrawCharts(const std::vector<pitviper::Chart>* charts, int columns,
                                                                          pitviper::ChartsReply* reply) {
  answer(*reply, [&] { return pitviper::drawSheet(*charts, columns); });
}

extern "C" __attribute__((visibility("default"))) void pitviperDrawTrajectories(const pitviper::FlownScene* scene, pitviper::ChartsReply* reply) {
  answer(*reply, [&] { return pitviper::drawTrajectorySheet(*scene); });
}
