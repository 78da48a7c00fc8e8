#include "splitfusion/lib/energy/term_state.h"

#include <algorithm>
#include <typeinfo>
#include <utility>

#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_call.h"

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
    TermState* state = Keep(name, *energy[i].term);
    if (state == nullptr) continue;
    CallTerm(name, "Prepare()", [&] { energy[i].term->Prepare(input, state); });
  }
}

TermState* TermStates::Keep(const std::string& name, const EnergyTerm& term) {
  const auto known = states_.find(name);
  if (known != states_.end() && known->second.of == typeid(term)) {
    if (known->second.state != nullptr) return known->second.state.get();
  }
  auto state = CallTerm(name, "NewState()", [&] { return term.NewState(); });
  const auto saved = saved_.find(name);
  if (state != nullptr && saved != saved_.end()) {
    CallTerm(name, "Load()", [&] { state->Load(saved->second); });
    saved_.erase(saved);
  }
  TermState* kept = state.get();
  states_.insert_or_assign(name, Kept{typeid(term), std::move(state)});
  return kept;
}

const TermState* TermStates::Find(const Energy& energy, std::size_t i) const {
  const auto found = states_.find(NameOf(energy, i));
  const EnergyTerm& term = *energy[i].term;
  return found == states_.end() || found->second.of != typeid(term)
             ? nullptr
             : found->second.state.get();
}

std::map<std::string, std::string> TermStates::Save() const {
  std::map<std::string, std::string> saved = saved_;
  for (const auto& [name, kept] : states_) {
    const TermState* state = kept.state.get();
    if (state == nullptr) continue;
    saved[name] = CallTerm(name, "Save()", [&] { return state->Save(); });
  }
  return saved;
}

}  // namespace splitfusion
