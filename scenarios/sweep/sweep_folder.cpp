#include "scenarios/sweep/sweep_folder.hpp"

#include <algorithm>
#include <memory>

#include "scenarios/reader/builder.hpp"
#include "scenarios/sweep/sweep_csv.hpp"
#include "scenarios/sweep/sweep_page.hpp"
#include "sim/frame/frame.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/frame/version.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {

SweepIdentity identityOf(const Sweep& sweep, const Simulation& sim) {
  int samples = 0;
  for (const Sample& s : sweep.samples) samples = std::max(samples, s.number + 1);
  return {sweep.name, sha256(sweep.sha256 + sim.sha256 + sim.content), sweep.scenario.filename().string(), kVersion, samples, sweep.factors, sweep.measures};
}

bool keepsFrames(const Sweep& sweep) { return sweep.keepsFrames || !sweep.sinks.items.empty(); }

std::filesystem::path frameFileOf(const std::filesystem::path& folder, const std::string& camera, int sample) {
  return folder / "frames" / (frameFileStem(camera, sample, "") + ".exr");
}

std::vector<const Sample*> missingSamples(const Sweep& sweep, const SweepStore& store, const PartChoice& part) {
  const std::vector<char> done = store.done();
  std::vector<const Sample*> missing;
  for (const Sample& s : sweep.samples)
    if (part.has(s.number) && !done[static_cast<std::size_t>(s.number)]) missing.push_back(&s);
  return missing;
}

void writeResults(const std::filesystem::path& folder, const Sweep& sweep, const SweepStore& store) {
  const std::vector<SweepRow> rows = store.rows();
  writeFileAtomically(folder / "sweep.csv", csvOf(store.identity(), rows));
  // What plans expect is no measure of the scene.
  SweepIdentity shown = store.identity();
  std::vector<SweepRow> shownRows = rows;
  if (!shown.measures.empty() && shown.measures.back().kind == Measure::Kind::Expected) {
    const std::size_t count = shown.measures.back().names.size();
    shown.measures.pop_back();
    for (SweepRow& r : shownRows) r.measures.resize(r.measures.size() - std::min(count, r.measures.size()));
  }
  writeSweepPage(folder / "sweep.html", shown, shownRows, sweep.kind == Design::SobolIndices);
}

void feedSinks(const std::filesystem::path& folder, const Sweep& sweep, const SweepStore& store, const Simulation& sim,
               const std::function<void(double)>& progress) {
  std::vector<std::unique_ptr<Sink>> sinks;
  for (const Value& written : sweep.sinks.items) sinks.push_back(readSink(written, sim).make(sim, {folder, {}}));
  if (sinks.empty()) return;
  for (const auto& s : sinks) s->start();
  const std::vector<SweepRow> rows = store.rows();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!rows[r].why.empty()) continue;
    for (const Camera& c : sim.cameras) {
      const std::filesystem::path file = frameFileOf(folder, c.name, rows[r].sample);
      if (!std::filesystem::exists(file))
        throw UserError({file.string(), 0, 0, -1}, "the frame of a sample that was drawn is not there", "all frames where the sweep wrote them",
                        "copy it here, or draw the sweep into another folder");
      auto frame = std::make_shared<Frame>(readFrame(file));
      frame->number = rows[r].sample;
      for (const auto& s : sinks) s->take(frame);
    }
    progress(static_cast<double>(r + 1) / static_cast<double>(rows.size()));
  }
  for (const auto& s : sinks) s->finish({});
}

}  // namespace pitviper
