// Possible contents of a disk after a power cut, from the log of all writes: flushed writes stand; after the
// last flush, each sector may be there or not, independently of its neighbours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::bench {

/// A file as memory.
class MappedFile {
public:
    MappedFile(const std::filesystem::path& path, bool to_write);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    [[nodiscard]] char* data() const { return data_; }
    [[nodiscard]] std::size_t size() const { return size_; }

private:
    char* data_ = nullptr;
    std::size_t size_ = 0;
};

/// As QEMU's blklogwrites writes it, in the form of Linux' dm-log-writes. An emulator that was killed leaves
/// an old count of entries: entries are read up to the first empty one.
class WriteLog {
public:
    struct Entry {
        bool is_flush = false;
        std::uint64_t at_byte = 0;
        std::string_view bytes{};
    };
    explicit WriteLog(const std::filesystem::path& path);
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

private:
    MappedFile file_;
    std::vector<Entry> entries_{};
};

/// A disk as it was before the log began; the file is changed.
class CutDisk {
public:
    CutDisk(const std::filesystem::path& disk, const WriteLog& log);

    /// Cuts the power before the entry `instant`. Instants come in order; the same one may come again.
    void cut(std::size_t instant, std::mt19937_64& lot);

private:
    void put(std::uint64_t at_byte, std::string_view bytes);

    MappedFile disk_;
    const WriteLog& log_;
    std::size_t flushed_ = 0;                       // entries that stand for good
    std::map<std::uint64_t, std::string> before_{}; // earlier contents of sectors that the last cut changed
};

} // namespace tappet::bench
