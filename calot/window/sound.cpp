#include "calot/window/sound.h"

#include <dlfcn.h>

#include <array>
#include <chrono>
#include <cstdlib>

#include <AL/al.h>
#include <AL/alc.h>

namespace calot::window {

namespace {

// Four buffers of 12 ms: what is heard is at most 50 ms old.
constexpr int kBuffers = 4, kSamples = 512;

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

/// ALSA complains at length on the standard error where there is no sound card; that is no trouble worth a word.
void hush_alsa() {
    void* library = ::dlopen("libasound.so.2", RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) return;
    using Handler = void (*)(const char* file, int line, const char* function, int error, const char* format, ...);
    using SetHandler = int (*)(Handler);
    if (const auto set = reinterpret_cast<SetHandler>(::dlsym(library, "snd_lib_error_set_handler"))) set(say_nothing);
}

}  // namespace

Sound::Sound() {
    hush_alsa();
    ::setenv("ALSOFT_LOGLEVEL", "0", 0);
    ALCdevice* device = alcOpenDevice(nullptr);
    if (device == nullptr) return;
    ALCcontext* context = alcCreateContext(device, nullptr);
    if (context == nullptr || alcMakeContextCurrent(context) == ALC_FALSE) {
        if (context != nullptr) alcDestroyContext(context);
        alcCloseDevice(device);
        return;
    }
    device_ = device;
    context_ = context;
    const ALCchar* name = alcGetString(device, ALC_DEVICE_SPECIFIER);
    device_name_ = name != nullptr ? name : "?";
    thread_ = std::thread([this] { work(); });
}

Sound::~Sound() {
    closing_ = true;
    if (thread_.joinable()) thread_.join();
    if (context_ == nullptr) return;
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(static_cast<ALCcontext*>(context_));
    alcCloseDevice(static_cast<ALCdevice*>(device_));
}

void Sound::set(const viewer::SoundScene& scene) {
    const std::lock_guard lock(mutex_);
    scene_ = scene;
}

void Sound::work() {
    viewer::Synth synth;
    std::array<std::int16_t, kSamples> samples{};
    std::array<ALuint, kBuffers> buffers{};
    ALuint source = 0;
    alGenSources(1, &source);
    alGenBuffers(kBuffers, buffers.data());
    auto fill = [&](ALuint buffer) {
        viewer::SoundScene scene;
        {
            const std::lock_guard lock(mutex_);
            scene = scene_;
        }
        synth.render(scene, samples.data(), kSamples);
        alBufferData(buffer, AL_FORMAT_MONO16, samples.data(), kSamples * static_cast<ALsizei>(sizeof(std::int16_t)),
                     viewer::Synth::kRate);
        alSourceQueueBuffers(source, 1, &buffer);
    };
    for (const ALuint buffer : buffers) fill(buffer);
    while (!closing_) {
        ALint played = 0;
        alGetSourcei(source, AL_BUFFERS_PROCESSED, &played);
        for (; played > 0; --played) {
            ALuint buffer = 0;
            alSourceUnqueueBuffers(source, 1, &buffer);
            fill(buffer);
        }
        ALint state = 0;
        alGetSourcei(source, AL_SOURCE_STATE, &state);
        if (state != AL_PLAYING) alSourcePlay(source);  // at the start, and when we were too late
        std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    alSourceStop(source);
    alDeleteSources(1, &source);
    alDeleteBuffers(kBuffers, buffers.data());
}

}  // namespace calot::window
