// The data partition of a box that is switched off, accessed by the tools of its file system: what the box
// will find there, and what it left.
#pragma once

#include "tests/toolchain/program.hpp"
#include "toolchain/tools/image/disk.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace tappet::bench {

class DataPartition {
public:
    /// The folder `work` is used for its files alone.
    DataPartition(std::filesystem::path disk, std::filesystem::path work)
        : disk_{std::move(disk)}, work_{std::move(work)} {
        std::filesystem::create_directories(work_);
    }

    void write(const std::string& file, const std::string& text) const {
        image::write_file(work_ / "file", text);
        change("write " + (work_ / "file").string() + " " + file);
    }
    void make_folder(const std::string& folder) const { change("mkdir " + folder); }

    /// The file as it was left, even without an orderly shutdown. Empty when there is no such file.
    [[nodiscard]] std::string read(const std::string& file) const {
        copy_out();
        std::filesystem::remove(work_ / "file");
        run_line("/usr/sbin/e2fsck -p " + partition());
        run_line("/usr/sbin/debugfs -R 'dump " + file + " " + (work_ / "file").string() + "' " + partition());
        return std::filesystem::exists(work_ / "file") ? image::read_file(work_ / "file") : std::string{};
    }

    /// Fills it so that not one block is left.
    void fill() const {
        copy_out();
        run_line("/usr/sbin/e2fsck -p " + partition());
        for (std::size_t kib = 64 * 1024; kib != 0; kib /= 2) {
            const std::string junk = (work_ / ("junk" + std::to_string(kib))).string();
            image::write_file(junk, std::string(kib * 1024, 'j'));
            run_line("/usr/sbin/debugfs -w -R 'write " + junk + " junk" + std::to_string(kib) + "' " +
                     partition());
            std::filesystem::remove(junk);
        }
        copy_in();
    }

    void damage(std::uint64_t at, std::uint64_t count) const {
        std::mt19937_64 lot{1};
        std::string bytes(count, '\0');
        std::ranges::generate(bytes, [&] { return static_cast<char>(lot()); });
        std::fstream disk{disk_, std::ios::binary | std::ios::in | std::ios::out};
        disk.seekp(static_cast<std::streamoff>(rows().first_sector * image::sector_bytes + at));
        disk.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }

private:
    static const image::Partition& rows() { return image::partitions()[3]; }
    [[nodiscard]] std::string partition() const { return (work_ / "partition").string(); }
    void change(const std::string& how) const {
        copy_out();
        run_line("/usr/sbin/e2fsck -p " + partition());
        run_line("/usr/sbin/debugfs -w -R '" + how + "' " + partition());
        copy_in();
    }
    void copy_out() const {
        run_line("dd bs=512 status=none conv=sparse if=" + disk_.string() + " of=" + partition() +
                 " skip=" + std::to_string(rows().first_sector) + " count=" + std::to_string(rows().sectors));
    }
    void copy_in() const {
        run_line("dd bs=512 status=none conv=notrunc if=" + partition() + " of=" + disk_.string() +
                 " seek=" + std::to_string(rows().first_sector));
    }

    std::filesystem::path disk_, work_;
};

} // namespace tappet::bench
