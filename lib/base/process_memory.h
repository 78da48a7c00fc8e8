#ifndef SPLITFUSION_LIB_BASE_PROCESS_MEMORY_H_
#define SPLITFUSION_LIB_BASE_PROCESS_MEMORY_H_

#include <cstdint>

namespace splitfusion {

/// Largest resident size of this process so far, bytes.
std::int64_t PeakMemoryBytes();

/// Memory that could be taken without swapping, bytes; the largest number where
/// the system does not tell.
std::int64_t AvailableMemoryBytes();

/// Lets freed memory be used again instead of giving it back to the system:
/// every frame asks for the same images and lists, megabytes each, and fresh
/// pages cost more than what is done with them. For main(): it holds for the
/// whole program. Does nothing where the C library is not glibc.
void KeepFreedMemory();

/// Gives what is free at the moment back to the system all the same: what
/// thousands of frames leave between what is still used adds up. Does nothing
/// where the C library is not glibc.
void ReturnFreedMemory();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_PROCESS_MEMORY_H_
