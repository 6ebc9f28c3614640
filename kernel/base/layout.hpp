// Objects laid out one after the other in one piece of memory, which need not exist yet.
#pragma once

#include <cstddef>

namespace tappet {

/// The offset and the number of objects of a type.
template <class T>
struct PlacesOf {
    std::size_t at = 0;
    std::size_t count = 0;
};

class Layout {
public:
    constexpr std::size_t take(std::size_t bytes, std::size_t align) noexcept {
        at_ = (at_ + align - 1) / align * align;
        const std::size_t here = at_;
        at_ += bytes;
        return here;
    }
    template <class T>
    constexpr std::size_t take(std::size_t count = 1) noexcept {
        return take(count * sizeof(T), alignof(T));
    }
    /// Lays out as many objects as were counted.
    template <class T>
    constexpr void place(PlacesOf<T>& places) noexcept {
        places.at = take<T>(places.count);
    }
    [[nodiscard]] constexpr std::size_t used() const noexcept { return at_; }

private:
    std::size_t at_ = 0;
};

} // namespace tappet
