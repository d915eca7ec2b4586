// Ejects a flare that its scenario declares with `time: on_command`.
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

CommandModel ejectCommand() {
  const std::vector<Parameter> keys = {required(text("flare", "name of a flare with `time: on_command`; of a sequence one of `<name>_0`, `<name>_1`, ..."))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int index = storeOf(r, sim);
    const Store& store = sim.stores[static_cast<size_t>(index)];
    if (store.carrier >= 0 && r.given("at") && !lifetimeOf(sim, store.carrier).has(r.number("at")))
      throw UserError(r.where("at"), "'" + sim.entities[static_cast<size_t>(store.carrier)].name + "' isn't there when it should eject '" + store.name + "'",
                      "a time within its lifetime", "change 'at'");
    return [index](Courses& courses, double at_s) { courses.toEject.emplace_back(index, at_s); };
  };
  return {"eject",
          "Ejects a flare from where its carrier is then, with its velocity: that of its route, or of the `move` that put it there (where that has none, as "
          "fast as it came since the move before). Ejected once more it begins anew, and the one before is gone.",
          keys, read};
}

}  // namespace pitviper
