// A machine, placed in its static memory. It knows no thread; a world runs its engines. Its functions are
// divided into narrow views: its life, its observation, and requests to its engines.
#pragma once

#include "kernel/machine/instance/life.hpp"
#include "kernel/machine/instance/observation.hpp"
#include "kernel/machine/instance/phases.hpp"
#include "kernel/machine/instance/placed.hpp"
#include "kernel/machine/instance/property_store.hpp"
#include "kernel/machine/instance/requests.hpp"

#include <atomic>
#include <expected>
#include <optional>
#include <span>
#include <string_view>

namespace tappet {

/// The reason of a stop request: the first call wins.
struct StopRequest {
    StopReason reason = StopReason::none;
    std::uint64_t detail = 0; ///< stale input: the connection row; missed deadline: the function
    const Engine* from = nullptr;
};

/// Not real-time except where stated. One machine has one instance at a time.
class MachineInstance : public PlacedMachine {
public:
    MachineInstance(const AcceptedMachine& machine, os::Clock& clock) noexcept
        : PlacedMachine{machine, clock} {}

    // ---- before configure()

    /// Sets the store from which rows with a properties file read their values.
    void read_properties_from(const PropertyStore& store) noexcept {
        expect_unconfigured();
        store_ = store;
    }
    /// Sets the directory of the socket for browsers, instead of the board's. The string must outlive the
    /// instance.
    void browse_in(std::string_view directory) noexcept {
        expect_unconfigured();
        browsing_directory_ = directory;
    }

    /// Another process will watch its engines: they are placed in memory that both share, whether or not a
    /// component sees the machine.
    void be_guarded() noexcept {
        expect_unconfigured();
        is_guarded_ = true;
    }

    /// Constructs, wires and configures. A repeated call, while the machine is stopped, builds everything
    /// anew. The error is the first component's refusal.
    std::expected<Standing, Sentence> configure(std::span<const ProvidedDevice> devices);

    [[nodiscard]] const PropertyStore& property_store() const noexcept { return store_; }
    /// Returns the directory of the socket for browsers; empty: no socket.
    [[nodiscard]] std::string_view browsing_directory() const noexcept {
        return browsing_directory_.empty() ? machine().board->browsing.directory : browsing_directory_;
    }

    // ---- views

    [[nodiscard]] MachineLife& life() noexcept TAPPET_REALTIME { return life_; }
    [[nodiscard]] const MachineLife& life() const noexcept TAPPET_REALTIME { return life_; }
    [[nodiscard]] MachineRequests& requests() noexcept TAPPET_REALTIME { return requests_; }
    [[nodiscard]] MachineObservation& observation() noexcept TAPPET_REALTIME { return observation_; }
    [[nodiscard]] const MachineObservation& observation() const noexcept TAPPET_REALTIME {
        return observation_;
    }

    // ---- stopping

    /// Places the stop request in memory in which another process can see it; the memory must outlive the
    /// instance. Call it before anything runs.
    static constexpr std::size_t stop_request_bytes = 64;
    void keep_stop_request_in(std::span<std::byte, stop_request_bytes> shared) noexcept {
        auto* kept = reinterpret_cast<KeptStop*>(shared.data());
        if (stop_asked() && kept->asked.load(std::memory_order_acquire) == 0) {
            kept->request = stop_request();
            kept->at = stop_asked_at();
            kept->asked.store(2, std::memory_order_release);
        }
        stop_ = kept;
    }
    /// Asks the supervisor to stop the machine. Real-time, any thread.
    void ask_stop(StopReason reason, std::uint64_t detail, const Engine* from) noexcept TAPPET_REALTIME;
    /// Requests a stop for a row of a section that another folder adds to the table; the folder describes the
    /// reason.
    void ask_section_stop(std::size_t section, std::size_t row, const Engine* from) noexcept TAPPET_REALTIME {
        ask_stop(StopReason::section, std::uint64_t{section} << 32 | row, from);
    }
    [[nodiscard]] bool stop_asked() const noexcept TAPPET_REALTIME {
        return stop_->asked.load(std::memory_order_acquire) == 2;
    }
    [[nodiscard]] const StopRequest& stop_request() const noexcept { return stop_->request; }
    /// Returns the time of a requested stop, by the machine's clock.
    [[nodiscard]] Time stop_asked_at() const noexcept { return stop_->at; }
    /// Returns when the outputs must be safe; after that the guardian makes them safe.
    [[nodiscard]] Time stop_due() const noexcept { return stop_asked_at() + machine().board->stop_within; }
    /// Describes a stop request in a sentence.
    [[nodiscard]] Sentence describe_stop() const;
    /// Woken when a stop is requested.
    [[nodiscard]] os::Waiter& supervisor() noexcept TAPPET_REALTIME { return supervisor_; }

    /// Returns the proof that nothing runs, for functions that need it; empty while anything runs or hangs.
    /// Call it from the thread that starts and stops the activities.
    [[nodiscard]] std::optional<Standing> standing() const noexcept {
        return is_configured_ && life_.stands() ? std::optional{Standing{}} : std::nullopt;
    }
    /// Writes every properties file anew; for a running machine see PropertySaving in
    /// kernel/services/configuration. The error is the first file that cannot be written; the others are
    /// written nevertheless. Without `standing` the result is an error, and no file is touched.
    [[nodiscard]] Sentence save_properties(std::optional<Standing> standing);

private:
    friend class MachineBuilder;

    /// All zero: no stop was requested.
    struct KeptStop {
        std::atomic<int> asked{0}; ///< 1: the request is being written; 2: it is written
        StopRequest request{};
        Time at{};
    };
    static_assert(sizeof(KeptStop) <= stop_request_bytes && static_cast<int>(StopReason::none) == 0);

    void expect_unconfigured() const noexcept { TAPPET_CONTRACT(!is_configured_, Contract::wrong_phase); }

    PropertyStore store_{};
    std::string_view browsing_directory_{};
    bool is_configured_ = false;
    bool is_guarded_ = false;
    os::Waiter supervisor_{};
    MachineLife life_{*this, supervisor_};
    MachineRequests requests_{*this};
    MachineObservation observation_{*this};
    KeptStop own_stop_{};
    KeptStop* stop_ = &own_stop_;
};

} // namespace tappet
