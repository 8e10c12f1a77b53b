#pragma once
// Video through the ffmpeg program, when there is one.

#include <memory>
#include <string>

#include "calot/render/renderer.h"

namespace calot::render {

class VideoWriter {
  public:
    /// True when an ffmpeg program is on PATH.
    static bool available();
    /// Starts `ffmpeg`; frames are piped to it. H.264 in MP4 (yuv420p, faststart) under a temporary name, renamed by
    /// finish().
    VideoWriter(const std::string& path, int width, int height, int frames_per_second);
    /// Without finish(): ends in order what was written, so that it is playable under its final name.
    ~VideoWriter();
    void add(const Image& image);  ///< throws std::runtime_error when ffmpeg is gone or the size differs
    void finish();                 ///< throws std::runtime_error with ffmpeg's last words when it failed

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace calot::render
