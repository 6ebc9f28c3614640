// The files of a line: those that a command reads, and those that it writes. They are on this host, or with a
// user elsewhere.
#pragma once

#include "toolchain/tools/browser/link.hpp"

namespace tappet::browser {

/// A file that grows while a machine runs.
class GrowingFile {
public:
    GrowingFile() = default;
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;
    virtual ~GrowingFile() = default;
    /// Does not wait: the machine's reader must keep up.
    virtual void write(std::string bytes) = 0;
    /// Returns whether so much waits to be written that the machine's reader must pause.
    [[nodiscard]] virtual bool is_behind() const = 0;
    /// Returns why it cannot be written, as soon as this is known; empty: no fault.
    [[nodiscard]] virtual std::string fault() const = 0;
    /// Waits until everything is written; the failure states why it could not be.
    virtual Result<void> finish() = 0;
};

class Files {
public:
    Files() = default;
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;
    virtual ~Files() = default;
    /// Returns the whole content.
    virtual Result<std::string> read(const std::string& name) = 0;
    /// Writes a file at once, in the place of an earlier one.
    virtual Result<void> write(const std::string& name, const std::string& bytes) = 0;
    /// Creates a new file; refuses an existing one.
    virtual Result<std::unique_ptr<GrowingFile>> create(const std::string& name) = 0;
    /// Returns whether there is a file of that name.
    [[nodiscard]] virtual bool exists(const std::string& name) = 0;
    /// Returns whether they are on this host, where other programs see them.
    [[nodiscard]] virtual bool are_here() const = 0;
};

/// The files of this host, by their paths.
class LocalFiles final : public Files {
public:
    Result<std::string> read(const std::string& name) override;
    Result<void> write(const std::string& name, const std::string& bytes) override;
    Result<std::unique_ptr<GrowingFile>> create(const std::string& name) override;
    [[nodiscard]] bool exists(const std::string& name) override;
    [[nodiscard]] bool are_here() const override { return true; }
};

/// The files of a user elsewhere: those that came with the line, and a function that passes on what is
/// written. A name is looked up among them only: it is no path of this host.
class FarFiles final : public Files {
public:
    using Given = std::map<std::string, std::string, std::less<>>;
    /// Passes on a part of a file, `last` with its end; at most most_in_a_part bytes. Returns false when the
    /// user has gone. Called from the thread of the line.
    using Put = std::function<bool(const std::string& name, std::string_view part, bool last)>;
    static constexpr std::size_t most_in_a_part = std::size_t{32} << 10;

    FarFiles(Given given, Put put) : given_{std::move(given)}, put_{std::move(put)} {}
    Result<std::string> read(const std::string& name) override;
    Result<void> write(const std::string& name, const std::string& bytes) override;
    Result<std::unique_ptr<GrowingFile>> create(const std::string& name) override;
    /// The user's own program knows it.
    [[nodiscard]] bool exists(const std::string&) override { return false; }
    [[nodiscard]] bool are_here() const override { return false; }

private:
    Given given_;
    Put put_;
};

} // namespace tappet::browser
