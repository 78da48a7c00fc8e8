#ifndef SPLITFUSION_LIB_SEQUENCE_PAIRED_FOLDERS_H_
#define SPLITFUSION_LIB_SEQUENCE_PAIRED_FOLDERS_H_

#include <string>
#include <vector>

#include "splitfusion/lib/sequence/association_list.h"

namespace splitfusion {

/// Colour and depth images in two folders of a sequence, paired by what their
/// names say, in this order of precedence:
///
/// - time stamps: `1311868164.363181.png`, `0000001-000000033369.png` (index,
///   then microseconds, as in Redwood's data), or an integer of 13, 16 or 19
///   digits (milli-, micro- or nanoseconds): the nearest ones, up to 0.02 s
///   apart
/// - numbers at their ends that colour and depth have in common, 30 a second
/// - their order, if there are as many of both, 30 a second
///
/// `color`, `depth`: names of the folders, relative to the sequence.
///
/// @throw InputError if a folder has no image, or they cannot be paired.
std::vector<AssociatedFiles> PairFolders(const std::string& sequence,
                                         const std::string& color,
                                         const std::string& depth);

/// The first of `names` that is a folder of the sequence; empty if none is.
std::string FirstFolder(const std::string& sequence,
                        const std::vector<std::string>& names);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_PAIRED_FOLDERS_H_
