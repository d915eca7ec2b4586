// Sets the throttle of an engine or a nozzle.
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel throttleCommand() {
  const std::vector<Parameter> keys = {required(text("plume", "name of a plume of an engine or a nozzle")),
                                       required(within(number("value", "", "as its key `throttle`: 0 idles or is out, 1 is all it has"), 0.0, 1.0))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    return [f = plumeOf(r, sim), value = r.number("value")](Courses& courses, double at_s) {
      constexpr double kKept_s = 1.0;  // what a nozzle's exhaust is the mean over is a tenth of that
      ThrottleSteps all;
      if (const auto before = courses.throttles.find(f); before != courses.throttles.end()) all = *before->second;
      std::erase_if(all.steps, [&](const auto& step) { return step.first >= at_s; });
      while (all.steps.size() > 1 && all.steps[1].first < at_s - kKept_s) all.steps.erase(all.steps.begin());
      all.steps.emplace_back(at_s, value);
      courses.throttles[f] = std::make_shared<const ThrottleSteps>(std::move(all));
    };
  };
  return {"throttle",
          "Sets the throttle of a plume, in place of its own course. An engine's exhaust follows at once, a nozzle's within a tenth of a second; a solid motor "
          "has none.",
          keys, read};
}

}  // namespace pitviper
