#include "splitfusion/lib/energy/term_state.h"

#include <algorithm>
#include <typeinfo>
#include <utility>

#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_call.h"
#include "splitfusion/lib/energy/term_unknowns.h"

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

void TermStates::BeginUnknowns(const Energy& energy,
                               const TermStates& background) {
  begun_.clear();
  for (std::size_t i = 0; i < energy.size(); ++i) {
    const std::string name = NameOf(energy, i);
    const std::vector<Unknown> unknowns = DeclaredUnknowns(energy[i]);
    std::vector<double>& begun = begun_[name];
    for (std::size_t u = 0; u < unknowns.size(); ++u) {
      const TermStates& from =
          unknowns[u].start == UnknownStart::kBackground ? background : *this;
      const auto kept = from.unknowns_.find(name);
      const bool known = unknowns[u].start != UnknownStart::kInitial &&
                         kept != from.unknowns_.end() &&
                         kept->second.size() == unknowns.size();
      begun.push_back(known ? kept->second[u] : unknowns[u].initial);
    }
  }
}

const std::vector<double>* TermStates::Begun(const Energy& energy,
                                             std::size_t i) const {
  const auto begun = begun_.find(NameOf(energy, i));
  return begun == begun_.end() ? nullptr : &begun->second;
}

void TermStates::KeepUnknowns(const Energy& energy,
                              const std::vector<double>& values) {
  if (values.empty()) return;  // Of a solver that does not seek them.
  std::size_t first = 0;
  for (std::size_t i = 0; i < energy.size(); ++i) {
    const std::size_t count = DeclaredUnknowns(energy[i]).size();
    CheckOption(first + count <= values.size(), "unknowns", values.size(),
                "as many as the terms declare");
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    unknowns_[NameOf(energy, i)].assign(
        begin, begin + static_cast<std::ptrdiff_t>(count));
    first += count;
  }
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
