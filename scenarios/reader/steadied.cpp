#include "scenarios/reader/steadied.hpp"

#include <algorithm>

#include "sim/world/world.hpp"

namespace pitviper {
namespace {

const std::vector<std::string> kAngles{"roll", "pitch", "yaw"};

void hold(Steadied& angles, const Value& word) {
  const std::string name = readText(word, "stabilised");
  bool* const wanted = name == "roll" ? &angles.roll : name == "pitch" ? &angles.pitch : name == "yaw" ? &angles.heading : nullptr;
  if (!wanted)
    throw unknownWord(word.where, "a mount has no angle", name, kAngles,
                      name == "heading" ? "write 'yaw'" : "write 'stabilised: roll' or 'stabilised: [roll, pitch]'");
  if (*wanted) throw UserError(word.where, "'" + name + "' twice", "each angle once", "remove one");
  *wanted = true;
}

}  // namespace

Steadied readSteadied(const Record& camera, const Mount& mount, const Simulation& simulation) {
  Steadied angles;
  if (const Value* gimbal = camera.find("gimbal"))
    if (const Value* own = gimbal->find("stabilised");
        own && (own->kind == Value::Kind::List || std::find(kAngles.begin(), kAngles.end(), own->text) != kAngles.end()))
      throw UserError(own->where, "angles of a mount under 'gimbal', whose own 'stabilised' is true or false", "'stabilised' of the camera, beside 'gimbal'",
                      "move it there");
  if (!camera.given("stabilised")) return angles;
  const Value& value = camera.value("stabilised");
  if (value.kind == Value::Kind::List) {
    if (value.items.empty()) throw UserError(value.where, "no angle to hold", "roll, pitch or yaw", "write 'stabilised: roll', or remove it");
    for (const Value& word : value.items) hold(angles, word);
  } else {
    hold(angles, value);
  }
  if (mount.carrier < 0)
    throw UserError(value.where, "a stabilised mount that nothing carries", "'attached_to', whose turns it keeps from the camera",
                    "add it, or remove 'stabilised'");
  const bool looks = mount.looksAtPoint || mount.lookAtLight >= 0 || mount.lookAtEntity >= 0;
  if (looks && !camera.given("gimbal"))
    throw UserError(value.where, "a stabilised mount of a camera that looks at something by itself",
                    "a 'gimbal' on it, or no 'look_at', which is upright already", "remove 'stabilised'");
  if (angles.heading)
    angles.heading_rad = attitudeOf(advance(simulation, simulation.time.at(0)).entities[static_cast<std::size_t>(mount.carrier)].orientation).heading_rad;
  return angles;
}

}  // namespace pitviper
