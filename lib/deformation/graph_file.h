#ifndef SPLITFUSION_LIB_DEFORMATION_GRAPH_FILE_H_
#define SPLITFUSION_LIB_DEFORMATION_GRAPH_FILE_H_

#include <string>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

/// Writes `graph.json`: {"node_spacing", "neighbors_per_point", "positions":
/// [[x, y, z], ...], "edges": [[j, ...], ...], "first_seen": [frame, ...],
/// "parts": [[first node, first frame, frame behind the last or null], ...]};
/// positions canonical, metres; edges[i] are the neighbours of node i. Motions
/// are in motions.bin.
///
/// @throw InputError if the file cannot be written.
void WriteGraph(const std::string& path, const DeformationGraph& graph,
                int neighbors_per_point);

/// Reads what WriteGraph wrote; motions are identity. `neighbors_per_point`
/// may be null. "first_seen" and "parts" may be missing or empty.
///
/// @throw InputError on a missing or malformed file; names the field.
DeformationGraph ReadGraph(const std::string& path, int* neighbors_per_point);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_GRAPH_FILE_H_
