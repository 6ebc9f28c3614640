// A file that grows while a machine runs, and is on the disk up to the last second when the power fails.
#pragma once

#include "toolchain/tools/browser/link.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace tappet::browser {

/// Its own thread writes and waits for the disk, so that who reads the machine does not.
class RecordFile {
public:
    /// How often the disk is waited for.
    static constexpr std::chrono::milliseconds between_syncs{500};
    /// So much may wait for the disk; then who reads the machine is to wait.
    static constexpr std::size_t most_waiting = std::size_t{64} << 20;

    /// A new file; one that is there is refused.
    static Result<std::unique_ptr<RecordFile>> create(const std::string& name);
    /// Writes what is left.
    ~RecordFile();
    RecordFile(const RecordFile&) = delete;
    RecordFile& operator=(const RecordFile&) = delete;

    void write(std::string bytes);
    [[nodiscard]] bool is_behind() const;
    /// Waits until all is on the disk; the sentence says why it could not be written.
    Result<void> finish();
    /// The same sentence as soon as it is known; empty: all is well.
    [[nodiscard]] std::string fault() const;

private:
    RecordFile(std::string name, int descriptor);
    void run();
    [[nodiscard]] std::string put(const std::string& bytes) const;

    std::string name_;
    int descriptor_;
    mutable std::mutex mutex_{};
    std::condition_variable changed_{};
    std::string waiting_{};
    std::string fault_{};
    bool ending_ = false;
    std::thread thread_{};
};

/// Asks the program that records into the file to end; the sentence says that none does.
Result<void> stop_recording(const std::string& name);

/// All of a file.
Result<std::string> read_whole(const std::string& name);

} // namespace tappet::browser
