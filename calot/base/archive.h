#pragma once
// Plain values to bytes and back, little-endian as they lie in memory: what goes into a checkpoint besides the state.

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace calot {

/// The same code writes and reads: `archive.value(x)` appends x, or sets it. Reading past the end throws.
class Archive {
  public:
    Archive() = default;                                                               ///< writes
    explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reading_(true) {}  ///< reads

    bool reading() const { return reading_; }
    const std::string& bytes() const { return bytes_; }
    bool at_end() const { return at_ == bytes_.size(); }

    template <class T>
    void value(T& x) {
        static_assert(std::is_trivially_copyable_v<T>);
        raw(&x, sizeof(T));
    }
    void value(std::string& text) {
        auto count = static_cast<std::uint64_t>(text.size());
        value(count);
        if (reading_) text.resize(checked(count));
        raw(text.data(), text.size());
    }
    template <class T>
    void value(std::vector<T>& items) {
        auto count = static_cast<std::uint64_t>(items.size());
        value(count);
        if (reading_) items.resize(checked(count));
        if constexpr (std::is_trivially_copyable_v<T>)
            raw(items.data(), items.size() * sizeof(T));
        else
            for (T& item : items) item.archive(*this);
    }

  private:
    std::size_t checked(std::uint64_t count) const {
        if (count > bytes_.size()) throw std::runtime_error("damaged archive");
        return static_cast<std::size_t>(count);
    }
    void raw(void* data, std::size_t count) {
        if (count == 0) return;
        if (!reading_) {
            bytes_.append(static_cast<const char*>(data), count);
            return;
        }
        if (count > bytes_.size() - at_) throw std::runtime_error("damaged archive");
        bytes_.copy(static_cast<char*>(data), count, at_);
        at_ += count;
    }

    std::string bytes_;
    std::size_t at_ = 0;
    bool reading_ = false;
};

}  // namespace calot
