#ifndef SPLITFUSION_LIB_EXPERIMENT_SEQUENCE_LIST_H_
#define SPLITFUSION_LIB_EXPERIMENT_SEQUENCE_LIST_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/experiment.h"

namespace splitfusion {

/// A sequence by its folder, named by the last part of the path.
///
/// @param ground_truth "auto" (FOLDER/gt or FOLDER, where groundtruth.txt is),
///     "none", a folder with a groundtruth.txt, or one that holds such a folder
///     per sequence name.
/// @param root folder that relative paths start from.
/// @throw InputError if a folder does not exist.
SequenceEntry MakeSequence(const std::string& folder,
                           const std::string& ground_truth,
                           const std::string& root);

/// Sequences of a command line: folders and list files, separated by commas; a
/// list has one folder a line, relative to the list, `#` comments. Sequences of
/// one file, as `scene.sens`, are named like folders.
///
/// @throw InputError as MakeSequence().
std::vector<SequenceEntry> ReadSequences(const std::string& text,
                                         const std::string& ground_truth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SEQUENCE_LIST_H_
