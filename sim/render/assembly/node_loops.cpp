#include "sim/render/assembly/node_loops.hpp"

#include <algorithm>
#include <sstream>

namespace pitviper {

void setLightLoops(ShaderSlots& slots) {
  const auto lights = slots.files.find("lights");
  const bool loops = lights != slots.files.end() && lights->second.ends_with("lights_many.glsl") && slots.constants["WRITTEN_OUT"] == 0;
  slots.constants["LIGHT_LOOPS"] = loops ? 1 : 0;
  slots.constants["LIGHT_TERMS"] = loops ? 0 : 1;
}

std::string nodesText(const std::string& name, int targets, int nodes, const std::string& call, bool reads) {
  std::ostringstream text;
  const auto place = [&](int i) { return name + std::to_string(i / 4) + "[" + std::to_string(i % 4) + "]"; };
  const int all = 4 * targets;
  text << "//@each q LIGHT_TERMS\n";
  for (int i = 0; i < all; ++i)
    text << "  " << place(i) << " = " << call << (reads ? place(i) + ", " : "")
         << (nodes > 0 ? std::to_string(std::min(i, nodes - 1)) : "min(firstNode + " + std::to_string(i) + ", NODES - 1)") << ");\n";
  text << "//@end\n//@each q LIGHT_LOOPS\n  {\n    float each[" << all << "];\n";
  for (int i = 0; reads && i < all; ++i) text << "    each[" << i << "] = " << place(i) << ";\n";
  text << "    for (int i = 0; i < " << all << "; ++i) each[i] = " << call << (reads ? "each[i], " : "") << "min(firstNode + i, NODES - 1));\n";
  for (int i = 0; i < all; ++i) text << "    " << place(i) << " = each[" << i << "];\n";
  text << "  }\n//@end\n";
  return text.str();
}

}  // namespace pitviper
