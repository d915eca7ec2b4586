#include "sim/render/surface/class_programs.hpp"

namespace pitviper {

ClassPrograms::ClassPrograms(const ShaderLibrary& library, const ShaderSlots& slots, const RenderTables& tables, const std::vector<SurfaceClass>& classes,
                             const std::vector<std::string>& targets) {
  for (const SurfaceClass& c : classes) {
    ShaderSlots own = slots;
    addClassSlots(c, tables, own);
    programs_.emplace_back(library, own, targets, 0);
  }
}

void ClassPrograms::run(RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes,
                        const std::function<void(const ShadingProgram&)>& set) const {
  makeThose(into, pixels, classes);
  for (std::size_t c : classes) {
    programs_[c].use();
    if (set) set(programs_[c]);
    programs_[c].run(into, pixels.only(c));
  }
}

void ClassPrograms::run(RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes, const glm::ivec4& part) const {
  makeThose(into, pixels, classes);
  for (std::size_t c : classes) programs_[c].run(into, pixels.only(c), part);
}

void ClassPrograms::addTo(FirstDraws& first, RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes) const {
  for (std::size_t c : classes) programs_[c].addTo(first, into, pixels.only(c));
}

void ClassPrograms::makeThose(RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes) const {
  FirstDraws first;
  addTo(first, into, pixels, classes);
  first.make();
}

void ClassPrograms::addTo(std::vector<NamedProgram>& all) const {
  for (const ShadingProgram& p : programs_) all.push_back({"shading", p.text()});
}

}  // namespace pitviper
