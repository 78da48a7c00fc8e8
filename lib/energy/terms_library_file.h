#ifndef SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_FILE_H_
#define SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_FILE_H_

#include <string>

namespace splitfusion {

/// Why a shared library must not be opened: a file that ends before its
/// segments do, as of a copy under way, kills a program that maps it. Empty: no
/// reason, which is also said of what is no such file at all.
std::string WhyCutOff(const std::string& path);

/// The text of a symbol of a library, an array of characters, as far as the
/// symbol reaches.
std::string SymbolText(const void* symbol);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_FILE_H_
