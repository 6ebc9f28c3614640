// Memory of this process that others may map read-only: laid under a range of static memory before anything
// is built in it.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <expected>
#include <span>

namespace tappet::os {

/// Lays fresh, zeroed memory of a memfd under `range`, which is whole pages and in use by nobody. The memory
/// can afterwards be mapped through descriptor(), by any process that is given it, but never written and
/// never resized: it is sealed. Not real-time; the mapping outlives this object.
class SharedMemory {
public:
    SharedMemory() = default;
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    ~SharedMemory() { close(); }

    /// `name` is shown in /proc. The error names the cure.
    std::expected<void, Sentence> lay_under(std::span<std::byte> range, const char* name) noexcept;
    /// -1 before lay_under.
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
    void close() noexcept;

private:
    int descriptor_ = -1;
};

/// Fresh, zeroed pages that no other process sees; at an address of their own, so that memory may be laid
/// under them. Empty when the kernel has none. Not real-time.
[[nodiscard]] std::span<std::byte> map_pages(std::size_t bytes) noexcept;
/// Maps memory that was given as a descriptor, to read. Empty when it is refused. Not real-time.
[[nodiscard]] std::span<const std::byte> map_to_read(int descriptor) noexcept;
void unmap(std::span<const std::byte> range) noexcept;

} // namespace tappet::os
