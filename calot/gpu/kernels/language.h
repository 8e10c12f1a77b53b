// One kernel source, two languages: OpenCL C 1.2 and CUDA C++. Every source includes this file first and keeps to what
// both have: no vector types, no float atomics, structs of 32-bit members only. `real` is double where the device has
// it (DeviceInfo::has_double), else float: for what few items compute, and only there.
//
//   KERNEL void add(GLOBAL const float* a, GLOBAL float* b, int count) {
//       const int i = GLOBAL_ID;
//       if (i < count) b[i] += a[i];
//   }
//
// SHARED arrays, one for each group, are declared at the beginning of a kernel with a constant size; pointers to them
// are LOCAL. Every item of a group comes to every BARRIER.

#ifndef CALOT_LANGUAGE_H
#define CALOT_LANGUAGE_H

#if defined(__OPENCL_VERSION__)

// Multiplication and addition stay separate, as on the host.
#pragma OPENCL FP_CONTRACT OFF

typedef ulong u64;  // words of occupancy (deformation/work.h) only
#if defined(CALOT_DOUBLE)
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
#else
typedef float real;
#endif

#define KERNEL __kernel
#define FN static inline
#define GLOBAL __global
#define LOCAL __local
#define SHARED __local
#define CONSTANT __constant
#define GLOBAL_ID ((int)get_global_id(0))
#define LOCAL_ID ((int)get_local_id(0))
#define GROUP_ID ((int)get_group_id(0))
#define GROUP_SIZE ((int)get_local_size(0))
#define GROUPS ((int)get_num_groups(0))
#define BARRIER barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
#define ATOMIC_ADD(p, value) atomic_add((p), (value))
#define ATOMIC_OR(p, value) atomic_or((p), (value))
#define ATOMIC_AND(p, value) atomic_and((p), (value))
#define ATOMIC_MAX(p, value) atomic_max((p), (value))
#define ATOMIC_MIN(p, value) atomic_min((p), (value))
#define POPCOUNT(x) ((int)popcount((uint)(x)))
#define POPCOUNT64(x) ((int)popcount((ulong)(x)))
/// Leading zeros of a 32-bit word; 32 for 0.
#define CLZ(x) ((int)clz((uint)(x)))
#define FLOAT_OF(bits) as_float(bits)
#define BITS_OF(x) as_uint(x)
#define SQRT(x) sqrt(x)
#define EXP(x) exp(x)
#define LOG(x) log(x)
#define FLOOR(x) floor(x)
#define FABS(x) fabs(x)
#define FMIN(a, b) fmin((float)(a), (float)(b))
#define FMAX(a, b) fmax((float)(a), (float)(b))
#define IMIN(a, b) min((int)(a), (int)(b))
#define IMAX(a, b) max((int)(a), (int)(b))

#elif defined(__CUDACC__)

#define KERNEL extern "C" __global__
#define FN static __device__ inline
#define GLOBAL
#define LOCAL
#define SHARED __shared__
#define CONSTANT __device__ const
#define GLOBAL_ID ((int)(blockIdx.x * blockDim.x + threadIdx.x))
#define LOCAL_ID ((int)threadIdx.x)
#define GROUP_ID ((int)blockIdx.x)
#define GROUP_SIZE ((int)blockDim.x)
#define GROUPS ((int)gridDim.x)
#define BARRIER __syncthreads()
#define ATOMIC_ADD(p, value) atomicAdd((p), (value))
#define ATOMIC_OR(p, value) atomicOr((p), (value))
#define ATOMIC_AND(p, value) atomicAnd((p), (value))
#define ATOMIC_MAX(p, value) atomicMax((p), (value))
#define ATOMIC_MIN(p, value) atomicMin((p), (value))
#define POPCOUNT(x) __popc((unsigned int)(x))
#define POPCOUNT64(x) __popcll((unsigned long long)(x))
#define CLZ(x) __clz((int)(x))
#define FLOAT_OF(bits) __uint_as_float(bits)
#define BITS_OF(x) __float_as_uint(x)
#define SQRT(x) sqrtf(x)
#define EXP(x) expf(x)
#define LOG(x) logf(x)
#define FLOOR(x) floorf(x)
#define FABS(x) fabsf(x)
#define FMIN(a, b) fminf((a), (b))
#define FMAX(a, b) fmaxf((a), (b))
#define IMIN(a, b) min((int)(a), (int)(b))
#define IMAX(a, b) max((int)(a), (int)(b))
typedef unsigned int uint;
typedef unsigned char uchar;
typedef unsigned short ushort;
typedef unsigned long long u64;
typedef double real;

#else
#error "neither OpenCL C nor CUDA C++"
#endif

/// A bit of a bit array (base/array.h): 64-bit words of the host, little-endian, are pairs of these.
FN int test_bit(GLOBAL const uint* words, int i) { return (int)((words[i >> 5] >> (i & 31)) & 1u); }
/// The 32 bits from i on, bit i lowest.
FN uint bits_from(GLOBAL const uint* words, int i) {
    const uint shift = (uint)(i & 31);
    const uint low = words[i >> 5] >> shift;
    return shift == 0u ? low : low | (words[(i >> 5) + 1] << (32u - shift));
}

#endif
