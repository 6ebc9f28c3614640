// The log of changes: who asked what from where, the value before and after, and whether it was done.
#pragma once

#include "toolchain/tools/gateway/bounds.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::network {

/// A request that is to be logged.
struct Asked {
    std::string user{};
    std::string address{};
    std::string machine{};
    std::string line{};
    std::string values{}; ///< a JSON object: the values that it may change, by name
};

/// A file of JSON lines. A request is written before the machine gets it, so that no change stands nowhere;
/// its outcome is a second line of the same number. Files are rotated by size: FILE, FILE.1, FILE.2 ... A
/// written line survives the end of the gateway, not of the system: lines are not synced one by one.
class Audit {
public:
    /// An empty path: no log.
    explicit Audit(std::string path) : path_{std::move(path)} {}
    ~Audit();
    Audit(const Audit&) = delete;
    Audit& operator=(const Audit&) = delete;

    /// Opens the file, reads the numbers on, and answers each request whose outcome is missing: "unknown: the
    /// gateway ended before the answer", with the value as `value_now` gives it. Returns the error; empty:
    /// none.
    [[nodiscard]] std::string open(const std::function<std::string(const Asked& asked)>& value_now);

    /// Returns the number of the request; 0: it could not be written, so it must not be sent.
    [[nodiscard]] std::uint64_t asked(const Asked& asked);
    /// `outcome`: "done", "refused: ..", "failed: .." or "unknown: ..".
    void answered(std::uint64_t number, std::string_view outcome, std::string_view values_after);
    /// Logs what is no request: logins, lock-outs, sessions.
    void note(std::string_view user, std::string_view address, std::string_view what);
    [[nodiscard]] std::uint64_t repaired() const { return repaired_; }

private:
    [[nodiscard]] bool write(const std::string& line);
    void rotate();
    std::string name_of(unsigned file) const {
        return file == 0 ? path_ : path_ + "." + std::to_string(file);
    }

    std::string path_;
    int file_ = -1;
    std::size_t bytes_ = 0;
    std::uint64_t last_ = 0;
    std::uint64_t repaired_ = 0;
};

/// Returns the names whose values a line may change: "set a 1 b 2" gives a and b.
[[nodiscard]] std::vector<std::string> names_in(std::string_view line);
/// Returns whether the line asks for more than to look.
[[nodiscard]] bool is_change(std::string_view line);

} // namespace tappet::network
