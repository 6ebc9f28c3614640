// Memory of this process that others may map read-only: mapped under a range of static memory before anything
// is constructed there.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <span>

namespace tappet::os {

/// Maps fresh, zeroed memory of a memfd under `range`, which must be whole pages and unused. Any process that
/// gets descriptor() can map the memory, but never write or resize it: it is sealed. Not real-time; the
/// mapping outlives this object.
class SharedMemory {
public:
    SharedMemory() = default;
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    ~SharedMemory() { close(); }

    /// Maps the memory. `name` is shown in /proc. The error names the cure.
    std::expected<void, Sentence> lay_under(std::span<std::byte> range, const char* name) noexcept;
    /// Returns -1 before lay_under.
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    void close() noexcept;

private:
    int descriptor_ = -1;
};

/// Maps fresh, zeroed pages that no other process sees, at an address of their own, so that memory may be
/// mapped under them. Empty when the kernel has none. Not real-time.
[[nodiscard]] std::span<std::byte> map_pages(std::size_t bytes) noexcept;
/// Maps memory that was passed as a descriptor, for reading. Empty when it is refused. Not real-time.
[[nodiscard]] std::span<const std::byte> map_to_read(int descriptor) noexcept;
void unmap(std::span<const std::byte> range) noexcept;

} // namespace tappet::os
