// Things laid one after the other in one piece of memory, which need not be there yet.
#pragma once

#include <cstddef>

namespace tappet {

/// Where so many objects of a type lie.
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
    /// As many as were counted.
    template <class T>
    constexpr void place(PlacesOf<T>& places) noexcept {
        places.at = take<T>(places.count);
    }
    [[nodiscard]] constexpr std::size_t used() const noexcept { return at_; }

private:
    std::size_t at_ = 0;
};

} // namespace tappet
