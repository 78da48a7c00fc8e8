#ifndef SPLITFUSION_LIB_EXPERIMENT_TASK_LIST_H_
#define SPLITFUSION_LIB_EXPERIMENT_TASK_LIST_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/task.h"

namespace splitfusion {

/// Writes tasks, one a line of JSON, into a file of `folder` whose name is made
/// of its content: a list that jobs wait for is never changed by a later one.
/// Returns its path.
///
/// @throw InputError if it cannot be written.
std::string WriteTaskList(const std::string& folder,
                          const std::vector<Task>& tasks);

/// The task of a line of such a file, counted from 1.
///
/// @throw InputError if the file cannot be read, has no such line, or the line
///     is none that WriteTaskList() writes.
Task ReadTaskOfList(const std::string& path, int line);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_TASK_LIST_H_
