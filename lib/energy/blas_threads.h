#ifndef SPLITFUSION_LIB_ENERGY_BLAS_THREADS_H_
#define SPLITFUSION_LIB_ENERGY_BLAS_THREADS_H_

namespace splitfusion {

/// Sets the threads of OpenBLAS, if that is the BLAS at run time; nothing
/// otherwise. The dense blocks of a surface's factorisation are small: more
/// than one thread waits more than it works, and changes the last digits.
void SetBlasThreads(int threads);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLAS_THREADS_H_
