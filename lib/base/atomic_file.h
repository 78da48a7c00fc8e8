#ifndef SPLITFUSION_LIB_BASE_ATOMIC_FILE_H_
#define SPLITFUSION_LIB_BASE_ATOMIC_FILE_H_

#include <functional>
#include <ostream>
#include <string>

namespace splitfusion {

/// Writes a file through a temporary name in the same folder and renames it,
/// so that a reader never sees half of it and a failure leaves the old one.
/// Its folder is made if missing, but not the folders above: a run directory
/// that was removed while a program wrote into it does not come back.
///
/// @throw InputError if the file cannot be written; names the path.
void WriteFileAtomically(const std::string& path,
                         const std::function<void(std::ostream&)>& write);

/// The same for writers that want a path (grids, databases): `write` receives the
/// temporary path, which keeps the extension of `path`.
void WritePathAtomically(const std::string& path,
                         const std::function<void(const std::string&)>& write);

/// Whether files can be made in a folder: makes one under a name that none has
/// and removes it.
bool CanMakeFiles(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ATOMIC_FILE_H_
