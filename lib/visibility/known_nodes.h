#ifndef SPLITFUSION_LIB_VISIBILITY_KNOWN_NODES_H_
#define SPLITFUSION_LIB_VISIBILITY_KNOWN_NODES_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

/// For so many frames a node counts as seen lately: a quarter of a second.
constexpr int kLatelyFrames = 8;

/// Up to this length of its walk, metres, a node is firmly held by others.
constexpr double kFirmWalk = 0.4;

/// For every node, whether it had been seen by a frame
/// (DeformationGraph::first_seen); all nodes where that is not recorded of all
/// of them.
std::vector<char> SeenNodes(const DeformationGraph& graph, int frame);

/// For every node, whether it is known that in a frame it was where its motion
/// puts it: it had been seen by then (DeformationGraph::first_seen), and either
/// lately (DeformationGraph::sightings), or it is firmly held by nodes that
/// were. "Lately" ends with the last frame that showed anything of the surface.
///
/// What is not seen is hidden, out of the image, or not followed: no live
/// points were found for it. How firmly it is held is the mean number n of
/// steps that a random walk over the edges takes from it to a node seen lately,
/// as the length node_spacing * sqrt(n). The back of a body is held from all
/// around, and walks from there are short. What hangs on a narrow neck, or on
/// nothing but the edges that tie loose parts, has long ones, as most walks
/// come back before they pass the neck: the place of a piece of a leg that has
/// been behind the other one for a while is not known.
///
/// Walks follow the edges of the graph as it is now, between nodes that had
/// been seen by the frame. All nodes are known where first_seen is not recorded
/// of all of them; sightings that are not tell nothing.
std::vector<char> KnownNodes(const DeformationGraph& graph, int frame);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_KNOWN_NODES_H_
