#pragma once
// Plays the Synth through OpenAL, from a thread of its own. Silent where there is no sound device.

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "calot/viewer/synth.h"

namespace calot::window {

class Sound {
  public:
    Sound();
    ~Sound();
    Sound(const Sound&) = delete;
    Sound& operator=(const Sound&) = delete;

    void set(const viewer::SoundScene& scene);
    /// Name of the device; empty where there is none.
    const std::string& device() const { return device_name_; }

  private:
    void work();

    void* device_ = nullptr;   ///< ALCdevice
    void* context_ = nullptr;  ///< ALCcontext
    std::string device_name_;
    std::mutex mutex_;
    viewer::SoundScene scene_;
    std::atomic<bool> closing_{false};
    std::thread thread_;
};

}  // namespace calot::window
