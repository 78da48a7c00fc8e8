#ifndef SPLITFUSION_LIB_DEFORMATION_NODE_CHANGE_H_
#define SPLITFUSION_LIB_DEFORMATION_NODE_CHANGE_H_

#include <cstddef>
#include <numeric>
#include <vector>

namespace splitfusion {

/// What became of the nodes of a graph: some of them were kept, in their order,
/// and new ones follow.
struct NodeChange {
  int before = 0;         ///< Nodes before.
  std::vector<int> kept;  ///< Indices before of those kept, ascending.
  int added = 0;          ///< New nodes.

  /// All of `nodes` nodes stay, and there is no new one.
  static NodeChange None(int nodes) {
    NodeChange change{nodes, std::vector<int>(nodes), 0};
    std::iota(change.kept.begin(), change.kept.end(), 0);
    return change;
  }

  /// Nodes that are there no more.
  int forgotten() const { return before - static_cast<int>(kept.size()); }
  /// Whether nothing changed.
  bool none() const { return added == 0 && forgotten() == 0; }

  /// Index now of every node before; -1: forgotten.
  std::vector<int> Numbers() const {
    std::vector<int> numbers(before, -1);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      numbers[kept[i]] = static_cast<int>(i);
    }
    return numbers;
  }

  /// Leaves out the values of forgotten nodes. What follows those of the nodes
  /// before, of new ones, stays; the last nodes may have no value.
  template <typename T>
  void Apply(std::vector<T>* values) const {
    if (forgotten() == 0) return;
    std::size_t count = 0;
    for (const int i : kept) {
      if (i < static_cast<int>(values->size())) {
        (*values)[count++] = (*values)[i];
      }
    }
    for (std::size_t i = before; i < values->size(); ++i) {
      (*values)[count++] = (*values)[i];
    }
    values->resize(count);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_NODE_CHANGE_H_
