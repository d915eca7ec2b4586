#include "tests/fuzz/fuzz_grid.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>

#include "sim/scene/grid_import.hpp"
#include "tests/fuzz/fuzz_damage.hpp"

namespace pitviper {
namespace {

constexpr int kNodes = 4 * 3 * 5;

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

float valueOf(int array, int node) { return array == 0 ? 300.0f + 10.0f * static_cast<float>(node) : 0.001f * static_cast<float>(node); }

/// An array as VTK has it in a file: its size, then its numbers.
std::string block(int array) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(kNodes * sizeof(float)));
  for (int i = 0; i < kNodes; ++i) put(bytes, valueOf(array, i));
  return bytes;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto b = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[k])) : 0u; };
    const unsigned bits = b(i) << 16 | b(i + 1) << 8 | b(i + 2);
    for (int k = 0; k < 4; ++k) out += i + static_cast<std::size_t>(k) > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63u];
  }
  return out;
}

enum class Form { Words, Cells, Base64, Appended };

std::string vti(Form form) {
  const std::string extent = form == Form::Cells ? "0 4 0 3 0 5" : "0 3 0 2 0 4", data = form == Form::Cells ? "CellData" : "PointData";
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<ImageData WholeExtent=\""
      << extent << "\" Origin=\"0 0 0\" Spacing=\"0.5 0.25 2\">\n<Piece Extent=\"" << extent << "\">\n<" << data << ">\n";
  std::string appended;
  for (int array = 0; array < 2; ++array) {
    out << "<DataArray type=\"Float32\" Name=\"" << (array == 0 ? "T" : "CO2") << "\" ";
    switch (form) {
      case Form::Base64:
        out << "format=\"binary\">" << base64(block(array));
        break;
      case Form::Appended:
        out << "format=\"appended\" offset=\"" << appended.size() << "\">";
        appended += block(array);
        break;
      default:
        out << "format=\"ascii\">";
        for (int i = 0; i < kNodes; ++i) out << " " << valueOf(array, i);
    }
    out << "</DataArray>\n";
  }
  out << "</" << data << ">\n</Piece>\n</ImageData>\n";
  if (!appended.empty()) out << "<AppendedData encoding=\"raw\">\n_" << appended << "\n</AppendedData>\n";
  out << "</VTKFile>\n";
  return out.str();
}

std::string readAll(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string wrongWith(const GridData& grid) {
  const auto nodes = static_cast<std::size_t>(grid.nodes.x) * static_cast<std::size_t>(grid.nodes.y) * static_cast<std::size_t>(grid.nodes.z);
  if (grid.arrays.size() != 2) return "not two arrays";
  for (const auto& a : grid.arrays) {
    if (a.values.size() != nodes) return "an array of another size than the grid";
    for (float v : a.values)
      if (!std::isfinite(v)) return "a number that is none";
  }
  return "";
}

}  // namespace

std::vector<std::filesystem::path> writeSoundGrids(const std::filesystem::path& folder, const std::filesystem::path& vdb) {
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> paths;
  const std::pair<const char*, Form> forms[] = {
      {"words.vti", Form::Words}, {"cells.vti", Form::Cells}, {"base64.vti", Form::Base64}, {"raw.vti", Form::Appended}};
  for (const auto& [name, form] : forms) {
    paths.push_back(folder / name);
    write(paths.back(), vti(form));
  }
  if (!vdb.empty()) {
    paths.push_back(folder / vdb.filename());
    write(paths.back(), readAll(vdb));
  }
  return paths;
}

GridFuzzReport fuzzGrids(std::uint64_t seed, int iterations, const std::vector<std::filesystem::path>& sound, const std::filesystem::path& corpus_folder) {
  GridFuzzReport report;
  for (int i = 0; i < iterations; ++i) {
    std::mt19937_64 random(seed + static_cast<std::uint64_t>(i));
    const std::filesystem::path& origin = sound[static_cast<std::size_t>(i) % sound.size()];
    std::string bytes = readAll(origin);
    for (std::uint64_t k = 0, count = 1 + random() % 3; k < count; ++k) damageBytes(bytes, random);
    const std::filesystem::path file = corpus_folder / ("case" + std::to_string(i) + origin.extension().string());
    write(file, bytes);
    std::string wrong;
    try {
      wrong = wrongWith(importGrid(file, {"T", "CO2"}, {}));
      ++report.read;
    } catch (const UserError& error) {
      const std::string said = error.what();
      if (said.empty() || said.find('\n') != std::string::npos) wrong = "said in more than one line: " + said;
      else if (said.find(file.filename().string()) == std::string::npos) wrong = "the file is not named: " + said;
      ++report.refused;
    } catch (const std::exception& error) {
      wrong = error.what();
    }
    if (wrong.empty()) {
      std::filesystem::remove(file);
      continue;
    }
    ++report.failed;
    std::fprintf(stderr, "fuzz_grid: seed %llu: %s: %s\n", static_cast<unsigned long long>(seed + static_cast<std::uint64_t>(i)), file.c_str(), wrong.c_str());
  }
  return report;
}

}  // namespace pitviper
