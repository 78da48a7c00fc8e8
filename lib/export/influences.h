#ifndef SPLITFUSION_LIB_EXPORT_INFLUENCES_H_
#define SPLITFUSION_LIB_EXPORT_INFLUENCES_H_

#include <vector>

#include "splitfusion/lib/export/export_surface.h"

namespace splitfusion {

/// The skinning with the heaviest first, and at most `count` nodes of each
/// vertex, whose weights are scaled to the sum 1.
std::vector<Skinning> HeaviestFirst(const std::vector<Skinning>& skinning,
                                    int count);

/// How far vertices are from where their own skinning carries them, metres.
struct InfluenceError {
  double sum_of_squares = 0;  ///< Over vertices and frames.
  double vertices = 0;        ///< Number of these.
  double largest = 0;         ///< Of all.

  /// Root of the mean square; 0 of none.
  double RootMeanSquare() const;

  /// Adds those of another surface.
  InfluenceError& operator+=(const InfluenceError& other);
};

/// Of a surface in all its frames, carried by another skinning, `by`.
InfluenceError ErrorOf(const ExportSurface& surface,
                       const std::vector<Skinning>& by);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_INFLUENCES_H_
