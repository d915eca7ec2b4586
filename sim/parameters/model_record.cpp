#include "sim/parameters/model_record.hpp"

namespace pitviper {

std::map<std::string, Spectrum> spectraOf(const std::vector<Parameter>& parameters, const Record& record, const SpectrumOf& spectrumOf) {
  std::map<std::string, Spectrum> spectra;
  for (const Parameter& p : parameters)
    if (p.type == ParameterType::Spectrum && record.has(p.key)) spectra.emplace(p.key, spectrumOf(record.value(p.key), p));
  return spectra;
}

}  // namespace pitviper
