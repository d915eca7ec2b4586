#include "sim/render/field_draws.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "sim/model/field_states.hpp"
#include "sim/plan/field_steps.hpp"

namespace pitviper {
namespace {

/// Edge of a tile [pixels]: lists stay short, and few pixels wait for a neighbour's. Larger where a picture would have too many.
constexpr int kTile_px = 16, kMostTilesAcross = 128;

}  // namespace

FieldDraws::FieldDraws(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, const ShaderSlots& slots)
    : simulation_(simulation), bodies_(simulation.fields.size()) {
  for (size_t f = 0; f < bodies_.size(); ++f) {
    const FieldBody& field = simulation.fields[f];
    Body& body = bodies_[f];
    body.tables = makeFieldTables(simulation, plan, field);
    body.spectra.upload(body.tables.texels);
    ShaderSlots own = slots;
    own.files["field"] = field.source->shader();
    own.constants["GASES"] = body.tables.gases;
    own.constants["LEVELS"] = body.tables.levels;
    own.constants["FOURS"] = body.tables.fours;
    own.constants["SCATTERS"] = body.tables.scatters ? 1 : 0;
    own.constants["BLACK_AT"] = body.tables.blackAt;
    own.constants["BLACK_ENTRIES"] = kBlackEntries;
    body.steps = fieldSteps(simulation, plan, f);
    own.constants["FIELD_STEPS"] = body.steps;
    own.constants["MOST_LINES"] = fieldLinesAcross(plan.accuracy);
    const std::string key = field.source->shader() + " " + std::to_string(body.tables.gases) + " " + std::to_string(body.tables.levels) + " " +
                            std::to_string(body.tables.blackAt) + " " + std::to_string(body.steps) + (body.tables.scatters ? " scatters" : "");
    auto [at, isNew] = programs_.try_emplace(key);
    if (isNew)
      at->second = Program(assembleShader(library, "sim/render/glsl/full_screen.vert.glsl", own),
                           assembleShader(library, "sim/render/glsl/volume_field.frag.glsl", own));
    body.program = &at->second;
  }
}

void FieldDraws::listTiles(const View& view, const FieldState& field, Body& body) {
  const glm::ivec2 low(glm::floor(body.lines.low)), high = glm::min(glm::ivec2(glm::ceil(body.lines.high)), glm::ivec2(view.width, view.height));
  const glm::ivec2 size = glm::max(high - low, glm::ivec2(1));
  const int tile = std::max(kTile_px, (std::max(size.x, size.y) + kMostTilesAcross - 1) / kMostTilesAcross);
  const glm::ivec2 tiles = (size + tile - 1) / tile;
  body.grid = {low.x, low.y, tiles.x, tile};
  std::vector<std::vector<std::uint32_t>> lists(static_cast<size_t>(tiles.x) * static_cast<size_t>(tiles.y));
  for (const FieldElement& e : field.elements) {
    const FieldLines lines = elementLines(view, field, e);
    if (lines.isEmpty()) continue;
    const glm::ivec2 from = glm::clamp((glm::ivec2(glm::floor(lines.low)) - low) / tile, glm::ivec2(0), tiles - 1);
    const glm::ivec2 to = glm::clamp((glm::ivec2(glm::ceil(lines.high)) - low) / tile, glm::ivec2(0), tiles - 1);
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) lists[static_cast<size_t>(y * tiles.x + x)].push_back(static_cast<std::uint32_t>(e.texel));
  }
  std::vector<std::uint32_t> words(2 * lists.size());
  for (size_t t = 0; t < lists.size(); ++t) {
    words[2 * t] = static_cast<std::uint32_t>(words.size());
    words[2 * t + 1] = static_cast<std::uint32_t>(lists[t].size());
    words.insert(words.end(), lists[t].begin(), lists[t].end());
  }
  body.tiles.upload(words);
}

void FieldDraws::place(const View& view, const WorldState& state, std::vector<LayerPiece>& pieces) {
  const glm::dmat3 cameraFromLocal = glm::transpose(view.localFromCamera);
  for (size_t f = 0; f < bodies_.size(); ++f) {
    Body& body = bodies_[f];
    body.lines = {};
    const FieldState* field = fieldOf(state, f);
    if (!field || field->elements.empty()) continue;
    body.lines = fieldLines(view, *field);
    if (body.lines.isEmpty()) continue;
    if (body.uploaded != field->texels) {
      body.texels.upload(field->texels->texel);
      body.uploaded = field->texels;
    }
    listTiles(view, *field, body);
    const glm::dmat3 fieldFromCamera = glm::transpose(field->localFromField) * view.localFromCamera;
    const glm::dvec3 origin = cameraFromLocal * (field->origin - view.position);
    for (int r = 0; r < 3; ++r) body.row[r] = glm::vec4(fieldFromCamera[0][r], fieldFromCamera[1][r], fieldFromCamera[2][r], origin[r]);
    body.fine = static_cast<float>(origin.z - static_cast<double>(static_cast<float>(origin.z)));
    LayerPiece piece;
    piece.medium = true;
    piece.field = static_cast<int>(f);
    piece.low = field->low;
    piece.high = field->high;
    piece.origin = origin;
    piece.cameraFromBody = cameraFromLocal * field->localFromField;
    pieces.push_back(piece);
  }
}

glm::ivec4 FieldDraws::rectOf(int field) const {
  const FieldLines& lines = bodies_[static_cast<size_t>(field)].lines;
  const glm::ivec2 low(glm::floor(lines.low)), high(glm::ceil(lines.high));
  return {low.x, low.y, high.x - low.x, high.y - low.y};
}

const Program& FieldDraws::use(int field) {
  Body& body = bodies_[static_cast<size_t>(field)];
  const Program& program = *body.program;
  body.spectra.bindTexture(5, 4);
  body.texels.bindTexture(17, 4);
  body.tiles.bindTexture(19, 1, true);
  program.use();
  const char* rows[3] = {"fieldRow0", "fieldRow1", "fieldRow2"};
  for (int r = 0; r < 3; ++r) glUniform4fv(program.uniform(rows[r]), 1, &body.row[r].x);
  glUniform1f(program.uniform("fieldFine"), body.fine);
  const glm::vec2 low(body.lines.low), high(body.lines.high);
  glUniform4f(program.uniform("fieldRect"), low.x, low.y, high.x, high.y);
  glUniform1f(program.uniform("linesApart"), static_cast<float>(body.lines.apart_px));
  glUniform4i(program.uniform("tileGrid"), body.grid.x, body.grid.y, body.grid.z, body.grid.w);
  glUniform4f(program.uniform("planckRange"), body.tables.firstInverse_K, body.tables.entriesPerInverse, 0.0f, 0.0f);
  return program;
}

void FieldDraws::addPrograms(std::vector<NamedProgram>& all) const {
  for (const auto& [key, program] : programs_) all.push_back({"field " + key, program.text()});
}

}  // namespace pitviper
