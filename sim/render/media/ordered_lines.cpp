#include "sim/render/media/ordered_lines.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <string>
#include <utility>

#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

/// As in sim/render/media/glsl/hit_order.comp.glsl.
enum Total : std::size_t { kEvents, kSteps, kPanes, kSegments, kWords, kFieldPassages, kGoes, kMostEvents, kMostSteps, kMostWords, kTotals };
constexpr std::size_t kGroup = 64;
/// llvmpipe ends all loops of an invocation after 65535 rounds in all, without a word: Shell's method takes so many events in 50000, and as many things in each
/// other as have so many words are gone through four times.
constexpr std::size_t kMostEventsOfLine = 1024, kMostWordsOfLine = 8192;

}  // namespace

OrderedLines::OrderedLines(const ShaderLibrary& library, const ShaderSlots& slots, int firstFieldDraw)
    : program_(assembleShader(library, "sim/render/media/glsl/hit_order.comp.glsl", slots)), firstField_(firstFieldDraw) {}

OrderedLines::Lists OrderedLines::order(const HitLists& hits, std::size_t first, std::size_t count, std::span<const std::size_t> fieldEntries,
                                        const std::function<void(const Program&)>& set) {
  Lists lists;
  std::size_t all = 0;
  for (std::size_t n : fieldEntries) lists.fieldFirst.push_back(std::exchange(all, all + n));
  fieldEntries_.reserve(std::max<std::size_t>(all, 1) * sizeof(glm::uvec4));
  eventRoom_ = std::max(eventRoom_, roomFor(2 * count));
  stepRoom_ = std::max(stepRoom_, roomFor(2 * count));
  listRoom_ = std::max(listRoom_, roomFor(count));
  wordRoom_ = std::max(wordRoom_, roomFor(2 * count));
  lineSteps_.reserve(hits.lineCount() * sizeof(glm::uvec4));
  goes_.reserve((count + all) * sizeof(glm::uvec2));  // one, or as many as lines through a field, and one beside them
  for (;;) {
    events_.reserve(eventRoom_ * sizeof(glm::uvec4));
    steps_.reserve(stepRoom_ * sizeof(std::uint32_t));
    panes_.reserve(listRoom_ * sizeof(glm::uvec4));
    segments_.reserve(listRoom_ * sizeof(glm::uvec4));
    words_.reserve(wordRoom_ * sizeof(std::uint32_t));
    std::vector<std::uint32_t> totals(kTotals, 0);
    for (std::size_t f : lists.fieldFirst) totals.insert(totals.end(), {0u, static_cast<std::uint32_t>(f)});
    totals_.upload(totals);
    hits.bind(17, 18, 19, 6);
    fieldEntries_.bindStorage(3);
    totals_.bindStorage(8);
    events_.bindStorage(9);
    lineSteps_.bindStorage(10);
    steps_.bindStorage(11);
    panes_.bindStorage(12);
    segments_.bindStorage(13);
    words_.bindStorage(14);
    goes_.bindStorage(15);
    program_.use();
    set(program_);
    glUniform1i(program_.uniform("filmWidth"), hits.filmWidth());
    glUniform1i(program_.uniform("firstLine"), static_cast<GLint>(first));
    glUniform1i(program_.uniform("lineCount"), static_cast<GLint>(count));
    glUniform1i(program_.uniform("firstField"), firstField_);
    glUniform4i(program_.uniform("room"), static_cast<GLint>(eventRoom_), static_cast<GLint>(stepRoom_), static_cast<GLint>(listRoom_),
                static_cast<GLint>(wordRoom_));
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glDispatchCompute(static_cast<GLuint>(std::max<std::size_t>((count + kGroup - 1) / kGroup, 1)), 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    totals_.read(totals.data(), totals.size() * sizeof(std::uint32_t));
    const auto needs = [&](std::size_t& room, std::size_t needed) {
      const bool more = needed > room;
      if (more) room = roomFor(needed);
      return more;
    };
    // A line without room for its events told nothing of the rest.
    bool again = needs(eventRoom_, totals[kEvents]);
    again |= needs(stepRoom_, totals[kSteps]);
    again |= needs(listRoom_, std::max(totals[kPanes], totals[kSegments]));
    again |= needs(wordRoom_, totals[kWords]);
    if (again) continue;
    if (isSoftware() && (totals[kMostEvents] > kMostEventsOfLine || totals[kMostWords] > kMostWordsOfLine))
      throw GlError("a line of sight crosses " + std::to_string(totals[kMostEvents]) + " borders of what is seen through, " +
                    std::to_string(totals[kMostWords]) + " times in several at once; without a GPU " + std::to_string(kMostEventsOfLine) + " and " +
                    std::to_string(kMostWordsOfLine) + " are worked through; use fewer or simpler transparent bodies, or a GPU");
    lists.goes = totals[kGoes];
    lists.panes = totals[kPanes];
    lists.segments = totals[kSegments];
    lists.fieldPassages = totals[kFieldPassages];
    for (std::size_t f = 0; f < fieldEntries.size(); ++f) lists.fieldEntries.push_back(totals[kTotals + 2 * f]);
    return lists;
  }
}

void OrderedLines::bindSteps(unsigned steps, unsigned ofLines, unsigned goes) const {
  steps_.bindTexture(steps, 1, true);
  lineSteps_.bindTexture(ofLines, 4, true);
  goes_.bindTexture(goes, 1, true);
}

}  // namespace pitviper
