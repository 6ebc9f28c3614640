// The forbidden actions.
#include "tests/bench/probe/probe.hpp"

#include <cstdlib>
#include <ctime>

#include <sys/mman.h>

namespace tappet::probe {

namespace {

constexpr std::size_t page_bytes = 4096;
alignas(page_bytes) std::array<char, page_bytes> page{};

void spin_ms(long milliseconds) {
    timespec begin{};
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &begin);
    do clock_gettime(CLOCK_MONOTONIC, &now);
    while ((now.tv_sec - begin.tv_sec) * 1'000 + (now.tv_nsec - begin.tv_nsec) / 1'000'000 < milliseconds);
}

} // namespace

void commit(Fault fault) noexcept {
    switch (fault) {
    case Fault::nothing:
    case Fault::break_contract: return; // the component itself breaks it
    case Fault::allocate: {
        void* volatile piece =
            std::malloc(1000); // volatile: the compiler may omit a pair of malloc and free otherwise
        std::free(piece);
        return;
    }
    case Fault::map: {
        void* const piece =
            ::mmap(nullptr, page_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (piece != MAP_FAILED) ::munmap(piece, page_bytes);
        return;
    }
    case Fault::touch: // a locked page cannot be released
        ::munlock(page.data(), page.size());
        ::madvise(page.data(), page.size(), MADV_DONTNEED);
        *static_cast<volatile char*>(page.data()) = 1;
        return;
    case Fault::overrun: spin_ms(3); return;
    case Fault::crash: {
        static int* volatile nowhere = reinterpret_cast<int*>(64);
        *nowhere = 1;
        return;
    }
    case Fault::hang: spin_ms(10'000); return;
    }
}

} // namespace tappet::probe
