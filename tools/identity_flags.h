#ifndef SPLITFUSION_TOOLS_IDENTITY_FLAGS_H_
#define SPLITFUSION_TOOLS_IDENTITY_FLAGS_H_

#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/lib/report/run_identity.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"

namespace splitfusion {

/// Applies --set: flags of sf_run, and terms.NAME.KEY or CLASS.terms.NAME.KEY
/// for one option of the energy. Before any other flag is read.
///
/// @throw InputError if a key or value is unknown.
void ApplySetFlag(const TermRegistry& terms);

/// The frames and the camera of a sequence, as parts of an identity.
///
/// @throw InputError if an image cannot be read.
NamedValues InputParts(const ImageFolderReader& reader);

/// What decides the result of a run of these flags: the options of the method,
/// the contents of images, calibration, masks, labels and network, the method
/// itself and the libraries under it.
///
/// @throw InputError if something that the flags name cannot be read.
RunIdentity IdentityFromFlags(const ImageFolderReader& reader,
                              const TermRegistry& terms);

/// {"identity", "identity_parts", "defaults", "outputs"}, for programs.
std::string IdentityText(const RunIdentity& identity);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_IDENTITY_FLAGS_H_
