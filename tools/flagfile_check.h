#ifndef SPLITFUSION_TOOLS_FLAGFILE_CHECK_H_
#define SPLITFUSION_TOOLS_FLAGFILE_CHECK_H_

namespace splitfusion {

/// Checks every flagfile that the command line names, and those that they name.
/// A line is blank, a comment (`#`), `--name=value`, or `--name` or `--noname`
/// of a flag that is on or off. gflags passes over anything else in silence, to
/// which belong all flags after a line without dashes (the file is for the
/// programs of that name, it thinks).
///
/// @throw InputError on any other line, naming file and line; if a file is
///     missing or not a regular one; or if one names itself, over others too.
void CheckFlagfiles(int argc, char** argv);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_FLAGFILE_CHECK_H_
