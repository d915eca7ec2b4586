#include "sim/radiance/planck_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace pitviper {

PlanckTable::PlanckTable(std::span<const SpectralNode> nodes, double first_K, double last_K, double step_K)
    : first_K_(first_K),
      step_K_(step_K),
      nodes_(nodes.size()),
      planck_(nodes),
      made_(static_cast<std::size_t>(std::lround((last_K - first_K) / step_K)) + 1),
      rows_(made_.size()) {}

std::shared_ptr<const PlanckTable> PlanckTable::averaged(std::span<const SpectralNode> nodes, const std::shared_ptr<const PlanckTable>& parts,
                                                         std::span<const SpectralNode> partNodes) {
  if (!parts) return nullptr;
  std::map<double, std::size_t> at_um;
  for (std::size_t i = 0; i < partNodes.size(); ++i)
    if (const auto& members = partNodes[i].members; members.size() == 1) at_um[members.front().wavelength_um] = i;
  const std::shared_ptr<PlanckTable> table(new PlanckTable);
  table->of_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const auto& m : nodes[i].members) {
      const auto found = at_um.find(m.wavelength_um);
      if (found == at_um.end()) return nullptr;
      table->of_[i].emplace_back(found->second, m.share);
    }
  table->first_K_ = parts->first_K_, table->step_K_ = parts->step_K_;
  table->nodes_ = nodes.size();
  table->parts_ = parts;
  table->made_ = std::vector<std::once_flag>(parts->rows_.size());
  table->rows_.resize(parts->rows_.size());
  return table;
}

const std::vector<double>& PlanckTable::row(std::size_t number) const {
  std::vector<double>& row = rows_[number];
  std::call_once(made_[number], [&] {
    std::vector<double> all(2 * nodes_, 0.0);
    const std::span values = std::span(all).first(nodes_), slopes = std::span(all).last(nodes_);
    if (parts_) {
      const std::vector<double>& from = parts_->row(number);
      for (std::size_t i = 0; i < nodes_; ++i)
        for (const auto& [part, share] : of_[i]) values[i] += share * from[part], slopes[i] += share * from[parts_->nodes_ + part];
    } else {
      planck_.at(first_K_ + step_K_ * static_cast<double>(number), values, slopes);
      for (double& s : slopes) s *= step_K_;
    }
    row = std::move(all);
  });
  return row;
}

bool PlanckTable::at(double temperature_K, std::span<double> into) const {
  const double t = (temperature_K - first_K_) / step_K_;
  if (nodes_ == 0 || !(t >= 0.0 && t <= static_cast<double>(rows_.size() - 1))) return false;
  const auto number = std::min(static_cast<std::size_t>(t), rows_.size() - 2);
  const double u = t - static_cast<double>(number), v = 1.0 - u;
  const double p0 = v * v * (1.0 + 2.0 * u), p1 = u * u * (1.0 + 2.0 * v), s0 = u * v * v, s1 = -u * u * v;
  const std::vector<double>&low = row(number), &high = row(number + 1);
  for (std::size_t i = 0; i < nodes_; ++i) into[i] = p0 * low[i] + p1 * high[i] + s0 * low[nodes_ + i] + s1 * high[nodes_ + i];
  return true;
}

}  // namespace pitviper
