#include "splitfusion/lib/energy/term_state.h"

#include <algorithm>

#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {
namespace {

/// Name of the i-th term, apart from those of the same name before it.
std::string NameOf(const Energy& energy, std::size_t i) {
  const std::string& name = energy[i].options.name;
  const auto same = std::count_if(
      energy.begin(), energy.begin() + static_cast<std::ptrdiff_t>(i),
      [&](const WeightedTerm& term) { return term.options.name == name; });
  return same == 0 ? name : name + "." + std::to_string(same + 1);
}

}  // namespace

void TermStates::Prepare(const Energy& energy, const EnergyInput& input) {
  for (std::size_t i = 0; i < energy.size(); ++i) {
    const std::string name = NameOf(energy, i);
    std::unique_ptr<TermState>& state = states_[name];
    if (state == nullptr) {
      state = energy[i].term->NewState();
      const auto saved = saved_.find(name);
      if (state != nullptr && saved != saved_.end()) {
        state->Load(saved->second);
        saved_.erase(saved);
      }
    }
    if (state != nullptr) energy[i].term->Prepare(input, state.get());
  }
}

const TermState* TermStates::Find(const Energy& energy, std::size_t i) const {
  const auto found = states_.find(NameOf(energy, i));
  return found == states_.end() ? nullptr : found->second.get();
}

std::map<std::string, std::string> TermStates::Save() const {
  std::map<std::string, std::string> saved = saved_;
  for (const auto& [name, state] : states_) {
    if (state != nullptr) saved[name] = state->Save();
  }
  return saved;
}

}  // namespace splitfusion
