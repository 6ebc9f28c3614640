// A file that grows while a machine runs, and is on the disk up to the last second at a power failure.
#pragma once

#include "toolchain/tools/browser/files.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace tappet::browser {

/// Its own thread writes and waits for the disk, so that the reader of the machine need not wait.
class RecordFile final : public GrowingFile {
public:
    /// The interval of disk syncs.
    static constexpr std::chrono::milliseconds between_syncs{500};
    /// The largest amount that may wait for the disk; above it the machine's reader must pause.
    static constexpr std::size_t most_waiting = std::size_t{64} << 20;

    /// Creates a new file; refuses an existing one.
    static Result<std::unique_ptr<RecordFile>> create(const std::string& name);
    /// Writes the rest.
    ~RecordFile() override;

    void write(std::string bytes) override;
    [[nodiscard]] bool is_behind() const override;
    /// Waits until everything is on the disk.
    Result<void> finish() override;
    [[nodiscard]] std::string fault() const override;

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

/// Asks the program that records into the file to end; the failure states that none does.
Result<void> stop_recording(const std::string& name);

} // namespace tappet::browser
