#pragma once
// Spectra as users write them: a number with unit, a table, a file, a library name, a band, a black body, or a product of these.
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "sim/parameters/table.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Rows of one table, and of all tables of a scenario together. Every row between two knots costs 16 quadrature nodes a channel:
/// 100 000 are half a second of planning.
constexpr std::size_t kMostSpectrumRows = 100000;
constexpr std::size_t kMostRowsTogether = 4000000;

/// Where spectra are looked for. loadYaml reads a file into a tree (UserError where it can't).
struct SpectrumFiles {
  std::filesystem::path base;                  ///< folder of the scenario: relative file names start here
  std::vector<std::filesystem::path> library;  ///< folders of named spectra (<name>.yaml with a key `spectrum`)
  std::function<Value(const std::filesystem::path&, const Location& askedAt)> loadYaml;
  /// Shared by all readers of a scenario, so that many names of one large table cannot fill the memory.
  std::shared_ptr<std::size_t> rowsRead = std::make_shared<std::size_t>(0);
};

/// An end of the spectral axis that a change of unit has rounded past it (1000 um, 10 1/cm) put back; other wavelengths [um] as they are.
double onAxis(double wavelength_um);

/// How a spectrum may be written; for the key reference.
const ParameterTable& spectrumTable();

class SpectrumReader {
 public:
  explicit SpectrumReader(SpectrumFiles files) : files_(std::move(files)) {}

  /// Values converted to `unit`. `outside` holds where a table does not say its own (responses: Zero, others: Error).
  /// UserError for anything that cannot be such a spectrum.
  Spectrum read(const Value& value, std::string_view unit, std::string_view name, Outside outside = Outside::Error) const;
  const SpectrumFiles& files() const { return files_; }
  /// Counts the rows of a spectrum that is kept once more; UserError at `where` beyond kMostRowsTogether.
  void count(const Spectrum& spectrum, const Location& where) const;
  /// The same reader with file names relative to another folder.
  SpectrumReader in(const std::filesystem::path& base) const;

 private:
  Spectrum readMap(const Value& value, std::string_view unit, std::string_view name, Outside outside, int depth) const;
  Spectrum readAny(const Value& value, std::string_view unit, std::string_view name, Outside outside, int depth) const;
  Spectrum readLibrary(const std::string& word, const Location& where, std::string_view unit, std::string_view name, Outside outside, int depth) const;
  SpectrumFiles files_;
};

/// Two columns of numbers with a header that names their units in brackets: "wavelength [um], transmittance [1]".
/// Lines that begin with # are comments. At most kMostSpectrumRows rows.
Spectrum readSpectrumCsv(const std::filesystem::path& file, std::string_view unit, Outside outside, const Location& askedAt);

}  // namespace pitviper
