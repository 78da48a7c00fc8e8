#ifndef SPLITFUSION_LIB_SYNTHETIC_ROOM_H_
#define SPLITFUSION_LIB_SYNTHETIC_ROOM_H_

#include <cstdint>
#include <vector>

#include "splitfusion/lib/synthetic/solid.h"

namespace splitfusion {

/// Instance ids of a synthetic sequence; moving things first, as labels.json
/// has them. 0 is the background.
enum SyntheticInstanceId : std::uint8_t {
  kPersonId = 1,      ///< The walking person.
  kSoftObjectId = 2,  ///< The soft toy.
  kChairId = 3,       ///< A chair that never moves.
};

/// The static part of the scene. World frame: z up, origin on the floor, the
/// person walks around it; the camera stands at negative y and looks along y.
struct Room {
  std::vector<Solid> solids;  ///< Walls (first, inside out) and furniture.
  TexturedMesh surface;       ///< All of it as one mesh, world frame.
};

/// Builds the room: floor, walls, ceiling, and furniture of boxes, cylinders
/// and ellipsoids at many depths, so that a camera is held in all six degrees
/// of freedom from every view. Only textures depend on the seed.
Room MakeRoom(std::uint32_t seed);

/// Centre of the table top on which the toy stands, world frame, metres.
Eigen::Vector3f RoomTableTop();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_ROOM_H_
