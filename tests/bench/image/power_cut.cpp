// The log as QEMU writes it, in the form of dm-log-writes; a disk as a cut leaves it.
#include "tests/bench/image/power_cut.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tappet::bench {

namespace {

constexpr std::size_t sector_bytes = 512;
constexpr std::uint64_t flush_flag = 1, unit_access_flag = 2, discard_flag = 4;

std::uint64_t number_at(const char* bytes) {
    std::uint64_t number = 0;
    std::memcpy(&number, bytes, sizeof number);
    return number;
}

} // namespace

MappedFile::MappedFile(const std::filesystem::path& path, bool to_write) {
    const int file = ::open(path.c_str(), (to_write ? O_RDWR : O_RDONLY) | O_CLOEXEC);
    size_ = std::filesystem::file_size(path);
    void* const place =
        ::mmap(nullptr, size_, to_write ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, file, 0);
    if (file >= 0) ::close(file);
    if (place == MAP_FAILED) throw std::runtime_error("cannot map " + path.string());
    data_ = static_cast<char*>(place);
}

MappedFile::~MappedFile() { ::munmap(data_, size_); }

WriteLog::WriteLog(const std::filesystem::path& path) : file_{path, false} {
    if (file_.size() < sector_bytes || number_at(file_.data()) != 0x6a736677736872)
        throw std::runtime_error(path.string() + " is no log of writes");
    for (std::size_t at = sector_bytes; at + sector_bytes <= file_.size();) {
        const char* const entry = file_.data() + at;
        const std::uint64_t sector = number_at(entry), flags = number_at(entry + 16);
        const std::size_t count = number_at(entry + 8) * sector_bytes;
        at += sector_bytes;
        if (count == 0 && flags == 0) break;
        if ((flags & (discard_flag | unit_access_flag)) != 0 || at + count > file_.size())
            throw std::runtime_error(path.string() + " holds what this replay does not know");
        if (count != 0) entries_.push_back({false, sector * sector_bytes, {entry + sector_bytes, count}});
        if ((flags & flush_flag) != 0) entries_.push_back({.is_flush = true});
        at += count;
    }
}

CutDisk::CutDisk(const std::filesystem::path& disk, const WriteLog& log) : disk_{disk, true}, log_{log} {}

void CutDisk::put(std::uint64_t at_byte, std::string_view bytes) {
    if (at_byte + bytes.size() > disk_.size()) throw std::runtime_error("the log is not of this disk");
    bytes.copy(disk_.data() + at_byte, bytes.size());
}

void CutDisk::cut(std::size_t instant, std::mt19937_64& lot) {
    for (const auto& [at_byte, bytes] : before_) put(at_byte, bytes);
    before_.clear();
    const auto& entries = log_.entries();
    std::size_t flush = instant;
    while (flush > flushed_ && !entries[flush - 1].is_flush) --flush;
    for (; flushed_ < flush; ++flushed_) put(entries[flushed_].at_byte, entries[flushed_].bytes);

    // Random sectors, random writes, all, none; and, since a disk may write the last first, all of the end
    // and little of the earlier writes.
    enum { each_sector, each_write, all_or_none, the_end_first };
    const auto way = std::min<std::uint64_t>(lot() % 5, the_end_first);
    const std::size_t pending = instant - flushed_;
    const std::size_t end = pending == 0 ? 0 : lot() % pending;
    constexpr std::uint64_t sure = 256;
    const std::uint64_t chance = way == all_or_none ? lot() % 2 * sure : lot() % (sure + 1);
    for (std::size_t i = 0; i < pending; ++i) {
        const auto& entry = entries[flushed_ + i];
        const bool is_of_the_end = way == the_end_first && i >= end;
        const bool is_written = is_of_the_end || lot() % sure < chance;
        for (std::size_t at = 0; at < entry.bytes.size(); at += sector_bytes) {
            if (!(way == each_sector ? lot() % sure < chance : is_written)) continue;
            const std::uint64_t place = entry.at_byte + at;
            before_.try_emplace(place, disk_.data() + place, sector_bytes);
            put(place, entry.bytes.substr(at, sector_bytes));
        }
    }
}

} // namespace tappet::bench
