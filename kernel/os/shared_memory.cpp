// A memfd, mapped over static memory, then sealed against every other writer.
#include "kernel/os/shared_memory.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

// Since Linux 5.1; not in every C library's headers.
#if !defined(F_SEAL_FUTURE_WRITE)
#define F_SEAL_FUTURE_WRITE 0x0010
#endif

namespace tappet::os {

std::expected<void, Sentence> SharedMemory::lay_under(std::span<std::byte> range, const char* name) noexcept {
    close();
    const auto refused = [this](std::string_view what, std::string_view cure) {
        const int error = errno;
        close();
        return std::unexpected(Sentence{"the kernel refuses to share the machine's memory: ", what, " (",
                                        std::strerror(error), "); ", cure});
    };
    descriptor_ = memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (descriptor_ < 0) return refused("no memfd", "use a kernel with CONFIG_MEMFD_CREATE");
    if (ftruncate(descriptor_, static_cast<off_t>(range.size())) != 0)
        return refused("no memory of that size", "give the box more memory");
    if (mmap(range.data(), range.size(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, descriptor_, 0) !=
        range.data())
        return refused("it cannot be mapped",
                       "give the box more memory, and share before the heap is sealed");
    // This mapping stays writable, later ones do not.
    if (fcntl(descriptor_, F_ADD_SEALS, F_SEAL_FUTURE_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
        return refused("it cannot be sealed against other writers", "use Linux 5.1 or later");
    return {};
}

void SharedMemory::close() noexcept {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
}

std::span<const std::byte> map_to_read(int descriptor) noexcept {
    struct stat facts{};
    if (fstat(descriptor, &facts) != 0 || facts.st_size <= 0) return {};
    const auto bytes = static_cast<std::size_t>(facts.st_size);
    void* at = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, 0);
    if (at == MAP_FAILED) return {};
    return {static_cast<const std::byte*>(at), bytes};
}

std::span<std::byte> map_pages(std::size_t bytes) noexcept {
    void* at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) return {};
    return {static_cast<std::byte*>(at), bytes};
}

void unmap(std::span<const std::byte> range) noexcept {
    if (!range.empty()) munmap(const_cast<std::byte*>(range.data()), range.size());
}

} // namespace tappet::os
