#pragma once
// Controls of the stand-in for OpenHaptics' library: what tests tell it and ask it. The stand-in is a shared object
// that exports the functions of HDAPI that Calot calls, holds them to their rules, and records what it is told.

extern "C" {

struct StandInRecord {
    char configuration[64];     ///< of the last hdInitDevice, "(default)" for none
    int initialised, disabled;  ///< how often
    int device_open;            ///< 1 while a device is initialised
    int forces_enabled;
    int scheduler_running;
    int callbacks;               ///< scheduled now
    long frames;                 ///< ended in order
    double force_N[3];           ///< that acts on the hand now
    double most_force_N;         ///< so far, by magnitude
    int misuse;                  ///< calls against the rules: frames that overlap, forces outside frames, dead handles
    unsigned calibration_style;  ///< of the last hdUpdateCalibration
};

/// Everything as after loading: plugged in, calibrated, no errors, a stylus at rest in the middle.
void stand_in_reset();
void stand_in_record(struct StandInRecord* record);
/// The stylus: position in mm, its axes as columns of a 3 x 3 matrix, buttons as bits. Its velocity is that of getting
/// there from where it was in a millisecond.
void stand_in_set_stylus(const double* position_mm, const double* axes, int buttons);
/// The cable. While it is out, frames fail with HD_COMM_ERROR and hdInitDevice with HD_DEVICE_FAULT.
void stand_in_plug(int in);
/// The next frame ends with this error.
void stand_in_fail_once(unsigned code);
/// What hdCheckCalibration says; an update by hdUpdateCalibration makes it HD_CALIBRATION_OK.
void stand_in_set_calibration(unsigned state);
/// With `own` the scheduler calls from a thread of its own, about a thousand times a second; without, only in
/// stand_in_run().
void stand_in_use_thread(int own);
/// The scheduler's turn, so many times, from the calling thread. Returns how often callbacks were called.
int stand_in_run(int times);

}  // extern "C"
