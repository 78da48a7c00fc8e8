#ifndef SPLITFUSION_LIB_BASE_FREED_MEMORY_H_
#define SPLITFUSION_LIB_BASE_FREED_MEMORY_H_

namespace splitfusion {

/// Lets freed memory be used again instead of giving it back to the system:
/// every frame asks for the same images and lists, megabytes each, and fresh
/// pages cost more than what is done with them. For main(): it holds for the
/// whole program. Does nothing where the C library is not glibc.
void KeepFreedMemory();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_FREED_MEMORY_H_
