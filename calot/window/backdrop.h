#pragma once
// What is behind the panels while there is no patient: a still picture of the operating field, dimmed.

#include <string>

namespace calot::window {

class Backdrop {
  public:
    /// Reads a JPEG file. Without it the backdrop is black.
    explicit Backdrop(const std::string& file);
    ~Backdrop();
    Backdrop(const Backdrop&) = delete;
    Backdrop& operator=(const Backdrop&) = delete;

    /// Behind everything of ImGui's frame; covers the window.
    void draw() const;

  private:
    unsigned texture_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace calot::window
