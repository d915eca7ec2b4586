#pragma once
// What a model is made from: a record of its table, its spectra read.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/parameters/table.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Reads a spectrum's value as its parameter says.
using SpectrumOf = std::function<Spectrum(const Value&, const Parameter&)>;

/// Of the parameters that are spectra, those that are given.
std::map<std::string, Spectrum> spectraOf(const std::vector<Parameter>& parameters, const Record& record, const SpectrumOf& spectrumOf);

struct ModelRecord {
  const Record& record;
  const std::map<std::string, Spectrum>& spectra;
  const Spectrum& spectrum(const std::string& key) const { return spectra.at(key); }
};

}  // namespace pitviper
