#include "sim/render/field_draws.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/model/field_states.hpp"

namespace pitviper {
namespace {

/// Edge of a tile [pixels]: lists stay short, which leaves rounds for more lines at a nozzle, and few pixels wait for a neighbour's. Larger where a picture
/// would have too many.
constexpr int kTile_px = 4, kMostTilesAcross = 128;
/// A field whose depth is less than this part of the way to it has one stretch of air across it: as kEven of its shader.
constexpr double kEven = 0.1;
/// Many samples of a zoomed view are one pixel's: lines through each may lie farther apart.
constexpr double kOfMany = 2.0;
/// llvmpipe ends all loops of a pixel after 65535 rounds in all (LP_MAX_TGSI_LOOP_ITERATIONS), without a word: fewer lines before that. Rounds of a line
/// besides those of its elements and steps; each loop's last counts as well.
constexpr double kMostRounds = 60000.0, kOtherRounds = 16.0;

}  // namespace

FieldDraws::FieldDraws(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, const ShaderSlots& slots)
    : sampling_(FieldSampling::of(simulation, plan)) {
  for (size_t f = 0; f < simulation.fields.size(); ++f) {
    const FieldBody& field = simulation.fields[f];
    Body& body = bodies_.emplace_back(simulation, plan, field);
    ShaderSlots own = slots;
    own.files["field"] = field.source->shader();
    own.constants["MIXTURES"] = body.tables.mixtures;
    own.constants["LEVEL_FOURS"] = body.tables.levelFours;
    own.constants["FOURS"] = body.tables.fours;
    own.constants["SCATTERS"] = body.tables.scatters ? 1 : 0;
    for (const bool even : {false, true}) {
      own.constants["EVEN"] = even ? 1 : 0;
      std::string key = field.source->shader() + (even ? " far" : " near");
      for (const char* name : {"MIXTURES", "LEVEL_FOURS", "SCATTERS"}) key += " " + std::to_string(own.constants[name]);
      auto [at, isNew] = programs_.try_emplace(key);
      for (Program& program : at->second)
        if (isNew)
          program = Program(assembleShader(library, "sim/render/glsl/full_screen.vert.glsl", own),
                            assembleShader(library, "sim/render/glsl/volume_field.frag.glsl", own));
      (even ? body.far : body.near) = &at->second;
    }
  }
}

void FieldDraws::listTiles(const View& view, const FieldState& field, Body& body) {
  const glm::ivec2 low(glm::floor(body.lines.low)), high = glm::min(glm::ivec2(glm::ceil(body.lines.high)), glm::ivec2(view.width, view.height));
  const glm::ivec2 size = glm::max(high - low, glm::ivec2(1));
  const int tile = std::max(kTile_px, (std::max(size.x, size.y) + kMostTilesAcross - 1) / kMostTilesAcross);
  const glm::ivec2 tiles = (size + tile - 1) / tile;
  body.grid = {low.x, low.y, tiles.x, tile};
  struct List {
    std::vector<std::uint32_t> texel;
    FieldLines lines;
    int steps = 1;
  };
  std::vector<List> lists(static_cast<size_t>(tiles.x) * static_cast<size_t>(tiles.y));
  const auto tilesOf = [&](const glm::dvec2& from, const glm::dvec2& to, const auto& visit) {
    const glm::ivec2 first = glm::clamp((glm::ivec2(glm::floor(from)) - low) / tile, glm::ivec2(0), tiles - 1);
    const glm::ivec2 last = glm::clamp((glm::ivec2(glm::ceil(to)) - low) / tile, glm::ivec2(0), tiles - 1);
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) visit(lists[static_cast<size_t>(y * tiles.x + x)]);
  };
  for (const FieldLines::Part& part : body.lines.parts) {
    const FieldElement& e = field.elements[part.element];
    const int steps = body.steps[static_cast<size_t>(e.kind)];
    if (steps == 0) continue;
    const auto texel = static_cast<std::uint32_t>(e.texel);
    tilesOf(part.low, part.high, [&](List& list) {
      if (list.texel.empty() || list.texel.back() != texel) list.texel.push_back(texel);
      list.lines.parts.push_back(part);
      list.steps = std::max(list.steps, steps);
    });
  }
  std::vector<std::uint32_t> words(3 * lists.size());
  body.firstPixel = static_cast<int>(words.size());
  const glm::ivec2 grid = tiles * tile;
  words.resize(words.size() + 3 * static_cast<size_t>(grid.x) * static_cast<size_t>(grid.y));
  const auto bits = [](double v) { return std::bit_cast<std::uint32_t>(static_cast<float>(v)); };
  for (size_t t = 0; t < lists.size(); ++t) {
    const List& list = lists[t];
    words[3 * t] = static_cast<std::uint32_t>(words.size());
    words[3 * t + 1] = static_cast<std::uint32_t>(list.texel.size());
    words[3 * t + 2] = static_cast<std::uint32_t>(list.steps);
    words.insert(words.end(), list.texel.begin(), list.texel.end());
    if (list.texel.empty()) continue;
    const double listed = static_cast<double>(list.texel.size()), rounds = 2.0 * listed + list.steps * (6.0 + 2.0 * listed) + kOtherRounds;
    const int most = std::max(static_cast<int>(std::sqrt(kMostRounds / rounds)), 1);
    const glm::ivec2 corner = glm::ivec2(static_cast<int>(t) % tiles.x, static_cast<int>(t) / tiles.x) * tile;
    for (int y = corner.y; y < corner.y + tile; ++y)
      for (int x = corner.x; x < corner.x + tile; ++x) {
        const PixelLines p = pixelLines({&list.lines, 1}, low.x + x, low.y + y, std::min(most, kReferenceLines),
                                        view.zoomed ? LinesApart{kOfMany * body.coarser, 1} : LinesApart{body.coarser, 2});
        const size_t at = static_cast<size_t>(body.firstPixel) + 3 * static_cast<size_t>(y * grid.x + x);
        const bool alone = p.within.size() == 1 && p.outside == 0.0;
        words[at] = alone ? 0u : static_cast<std::uint32_t>(words.size());
        words[at + 1] = static_cast<std::uint32_t>(p.within.size());
        words[at + 2] = bits(p.outside);
        for (const FilmLine& line : p.within)
          if (!alone) words.insert(words.end(), {bits(line.at.x), bits(line.at.y), bits(line.share)});
      }
  }
  body.tiles.upload(words);
}

void FieldDraws::place(const View& view, const WorldState& state, std::vector<LayerPiece>& pieces) {
  for (size_t f = 0; f < bodies_.size(); ++f) {
    Body& body = bodies_[f];
    const FieldState* field = fieldOf(state, f);
    body.state = field && !field->elements.empty() ? field : nullptr;
    if (body.state) body.steps = sampling_->steps(f, state.time_s), body.coarser = sampling_->coarser(f, state.time_s);
    if (!body.state || fieldLines(view, *field).isEmpty()) continue;
    if (body.uploaded != field->texels) {
      body.texels.upload(field->texels->texel);
      body.uploaded = field->texels;
    }
    if (body.tables.mix(field->share)) body.spectra.upload(body.tables.texels);
    const glm::dmat3 cameraFromLocal = glm::transpose(view.localFromCamera);
    LayerPiece piece;
    piece.medium = true;
    piece.field = static_cast<int>(f);
    piece.low = field->low;
    piece.high = field->high;
    piece.origin = cameraFromLocal * (field->origin - view.position);
    piece.cameraFromBody = cameraFromLocal * field->localFromField;
    pieces.push_back(piece);
  }
}

void FieldDraws::look(const View& view) {
  const glm::dmat3 cameraFromLocal = glm::transpose(view.localFromCamera);
  for (Body& body : bodies_) {
    body.lines = {};
    if (!body.state) continue;
    const FieldState& field = *body.state;
    body.lines = fieldLines(view, field);
    if (body.lines.isEmpty()) continue;
    listTiles(view, field, body);
    double nearest = INFINITY, farthest = 0.0;
    for (const FieldElement& e : field.elements) {
      const double to = glm::length(field.origin + field.localFromField * e.centre - view.position);
      nearest = std::min(nearest, to - e.radius_m);
      farthest = std::max(farthest, to + e.radius_m);
    }
    body.range = farthest - nearest < kEven * nearest ? glm::vec2(nearest, farthest) : glm::vec2(0.0f);
    const glm::dmat3 fieldFromCamera = glm::transpose(field.localFromField) * view.localFromCamera;
    const glm::dvec3 origin = cameraFromLocal * (field.origin - view.position);
    for (int r = 0; r < 3; ++r) body.row[r] = glm::vec4(fieldFromCamera[0][r], fieldFromCamera[1][r], fieldFromCamera[2][r], origin[r]);
    body.fine = static_cast<float>(origin.z - static_cast<double>(static_cast<float>(origin.z)));
  }
}

glm::ivec4 FieldDraws::rectOf(int field) const {
  const FieldLines& lines = bodies_[static_cast<size_t>(field)].lines;
  const glm::ivec2 low(glm::floor(lines.low)), high(glm::ceil(lines.high));
  return {low.x, low.y, high.x - low.x, high.y - low.y};
}

const Program& FieldDraws::use(int field, bool covered) {
  Body& body = bodies_[static_cast<size_t>(field)];
  const Program& program = (*(body.range.y > 0.0f ? body.far : body.near))[covered ? 1 : 0];
  body.spectra.bindTexture(5, 4);
  body.texels.bindTexture(17, 4);
  body.tiles.bindTexture(19, 1, true);
  program.use();
  const char* rows[3] = {"fieldRow0", "fieldRow1", "fieldRow2"};
  for (int r = 0; r < 3; ++r) glUniform4fv(program.uniform(rows[r]), 1, &body.row[r].x);
  glUniform1f(program.uniform("fieldFine"), body.fine);
  glUniform1i(program.uniform("firstPixel"), body.firstPixel);
  glUniform2f(program.uniform("fieldRange"), body.range.x, body.range.y);
  glUniform4fv(program.uniform("gasLevels"), static_cast<GLsizei>(body.tables.temperatures.size()), &body.tables.temperatures[0].x);
  glUniform4i(program.uniform("tileGrid"), body.grid.x, body.grid.y, body.grid.z, body.grid.w);
  glUniform4f(program.uniform("planckRange"), body.tables.firstInverse_K, body.tables.entriesPerInverse, static_cast<float>(body.tables.blackAt),
              static_cast<float>(body.tables.blackEntries - 1));
  return program;
}

void FieldDraws::addPrograms(std::vector<NamedProgram>& all) const {
  for (const auto& [key, program] : programs_) all.push_back({"field " + key, program[0].text()});
}

}  // namespace pitviper
