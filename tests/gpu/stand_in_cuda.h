#pragma once
// Controls of the stand-in for NVIDIA's driver: what tests tell it and ask it. The stand-in is a shared object that
// exports the functions of the driver API that Calot calls, holds them to their rules, keeps memory on the host and
// records launches instead of running them.

extern "C" {

struct StandInCudaRecord {
    int contexts;                  ///< retained and not yet released
    int streams, events, modules;  ///< alive
    int buffers;                   ///< alive
    unsigned long long bytes;      ///< of them
    int launches, waits;
    int misuse;  ///< calls against the rules: no current context, unknown handles, pointers outside of a buffer
    // Of the last launch
    char function[64];
    unsigned int grid, block;
    int parameters;                    ///< that the launch's function has
    unsigned long long parameter[16];  ///< the first eight bytes of each, as the function's sizes say
};

/// Everything as after loading: one device of compute capability 9.0 with 8 MB.
void stand_in_cuda_reset();
void stand_in_cuda_record(struct StandInCudaRecord* record);
/// Devices, and the compute capability of each.
void stand_in_cuda_set_devices(int count, int major, int minor);
/// How many bytes each parameter of a function has, which a real module knows; ends with 0.
void stand_in_cuda_set_parameters(const char* function, const int* bytes);
/// From now on every call fails with this error, as after a device was lost; 0: none does.
void stand_in_cuda_fail(int error);

}  // extern "C"
