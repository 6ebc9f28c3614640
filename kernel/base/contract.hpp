// Broken contracts: faults of the program, never of the plant. Each has a permanent number, a sentence and
// its values, and calls the installed handler, which stops the machine safely. Operating errors are values,
// not contracts.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace tappet {

/// The numbers are in logs and manuals: they are never reused and never changed. 3, 101, 102, 301 and 402
/// belonged to contracts that nothing could break.
enum class Contract : std::uint16_t {
    index_out_of_range = 1,
    precondition = 2,
    not_a_number = 4,
    refused_settings = 5,
    single_writer = 103,
    single_reader = 104,
    command_sender = 105,
    timer_unserved = 106,
    engine_runs = 107,
    wrong_phase = 108,
    one_activity = 109,
    allocation_after_seal = 201,
    mapping_after_seal = 202,
    heap_exhausted = 203,
    heap_foreign_pointer = 204,
    heap_double_free = 205,
    heap_damaged = 206,
    heap_lock_failed = 207,
    memory_not_there = 208,
    step_limit_exceeded = 401,
};

/// The thread's fate after the handler returned. A thread that stops must not continue: its next step would
/// use what the contract says does not hold.
enum class AfterViolation : std::uint8_t { thread_stops, thread_goes_on };

struct ContractText {
    Contract id;
    std::string_view name;
    std::string_view sentence; ///< one {} for each value, in order
    AfterViolation after = AfterViolation::thread_stops;
};

// clang-format off
inline constexpr auto contract_texts = std::to_array<ContractText>({
    {Contract::index_out_of_range,     "index-out-of-range",     "Element {} was accessed, but there are only {}."},
    {Contract::precondition,           "precondition",           "A function was called with {}, which its declaration forbids."},
    {Contract::not_a_number,           "not-a-number",           "Argument element {} is not a finite number: check values where they enter."},
    {Contract::refused_settings,       "refused-settings",       "An object was created from settings that its check refuses: call check(...) on them first, and report its sentence."},
    {Contract::single_writer,          "single-writer",          "An output was written in activity {}: only its component writes it, in its own activity."},
    {Contract::single_reader,          "single-reader",          "An input was read in activity {}: only its component reads it, in its own activity."},
    {Contract::command_sender,         "command-sender",         "A command of sending activity {} was sent in activity {}: write sent_by(...) in its row."},
    {Contract::timer_unserved,         "timer-unserved",         "A timer that no engine serves was armed for {} ns in activity {}: declare it with timer<...>(...) in its component's interface."},
    {Contract::engine_runs,            "engine-runs",            "A function for a stopped engine was called while activity {} ran."},
    {Contract::wrong_phase,            "wrong-phase",            "A function for an unconfigured machine was called after configure(): call it before."},
    {Contract::one_activity,           "one-activity",           "A device of activity {} was used in activity {}: let only one component drive it."},
    {Contract::allocation_after_seal,  "allocation-after-seal",  "{} bytes were allocated after arming by the code at address {}.", AfterViolation::thread_goes_on},
    {Contract::mapping_after_seal,     "mapping-after-seal",     "{} bytes of address space were requested after arming by the code at address {}; refused.", AfterViolation::thread_goes_on},
    {Contract::heap_exhausted,         "heap-exhausted",         "{} bytes were requested from the arena, {} are free in it, {} in one piece: enlarge TAPPET_HEAP_ARENA.", AfterViolation::thread_goes_on},
    {Contract::heap_foreign_pointer,   "heap-foreign-pointer",   "Address {} was freed but never allocated."},
    {Contract::heap_double_free,       "heap-double-free",       "Address {} was freed twice."},
    {Contract::heap_damaged,           "heap-damaged",           "Memory before address {} was overwritten."},
    {Contract::heap_lock_failed,       "heap-lock-failed",       "The heap's lock was refused with error {}: malloc inside a signal handler, or a kernel without PI futexes."},
    {Contract::memory_not_there,       "memory-not-there",       "{} bytes could not be allocated for the code at address {}, which cannot continue without them."},
    {Contract::step_limit_exceeded,    "step-limit-exceeded",    "A procedure limited to {} steps requested step {}."},
});
// clang-format on

constexpr const ContractText* find_text(Contract id) noexcept TAPPET_REALTIME {
    for (const ContractText& row : contract_texts)
        if (row.id == id) return &row;
    return nullptr;
}

constexpr std::size_t values_of(Contract id) noexcept TAPPET_REALTIME {
    std::size_t count = 0;
    if (const ContractText* row = find_text(id))
        for (std::size_t i = 0; i + 1 < row->sentence.size(); ++i)
            if (row->sentence[i] == '{' && row->sentence[i + 1] == '}') ++count;
    return count;
}

/// The argument of a handler.
struct ContractViolation {
    static constexpr std::size_t max_values = 4;
    Contract id{};
    std::array<std::int64_t, max_values> values{};
    std::uint64_t address = 0; ///< address of the code that noticed; addr2line names it
};

/// Returns the sentence with its values: "contract 1 index-out-of-range: Element 8 was accessed, but there
/// are only 4. [code at 0x...]".
Sentence describe(const ContractViolation& breach) noexcept;

/// Brings the machine to its safe state. Called on the thread that broke the contract, possibly on several at
/// once. For a contract after which the thread stops it must not return: if it does, the process is aborted.
/// Real-time.
using ContractHandler = void (*)(const ContractViolation&) noexcept TAPPET_REALTIME;

/// Installs a handler, and returns the one before. nullptr, as at the start, means: print on standard error
/// and abort. Real-time.
ContractHandler install_contract_handler(ContractHandler handler) noexcept TAPPET_REALTIME;

/// Calls the handler. It returns only from contracts after which the thread goes on. Real-time until it
/// aborts.
void break_contract(const ContractViolation& breach) noexcept TAPPET_REALTIME;

template <class T>
concept ContractValue = std::integral<T> || std::is_enum_v<T> || std::is_pointer_v<T> ||
                        requires(T t) { std::chrono::nanoseconds{t}.count(); };

template <ContractValue T> std::int64_t contract_value(const T& value) noexcept TAPPET_REALTIME {
    if constexpr (std::is_pointer_v<T>)
        return static_cast<std::int64_t>(reinterpret_cast<std::uintptr_t>(value));
    else if constexpr (std::integral<T> || std::is_enum_v<T>)
        return static_cast<std::int64_t>(value);
    else
        return std::chrono::nanoseconds{value}.count();
}

/// Called by TAPPET_CONTRACT. Not constexpr on purpose: a broken contract in a constant expression does not
/// compile.
template <Contract id, ContractValue... Values>
[[gnu::cold, gnu::noinline]] void contract_broken(const Values&... values) noexcept TAPPET_REALTIME {
    static_assert(find_text(id) != nullptr, "a contract has a row in contract_texts");
    static_assert(sizeof...(Values) == values_of(id),
                  "a contract gets one value for each {} of its sentence");
    const auto address = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
    break_contract(ContractViolation{id, {contract_value(values)...}, address});
}

} // namespace tappet

///     TAPPET_CONTRACT(index < rows.size(), Contract::index_out_of_range, index, rows.size());
#define TAPPET_CONTRACT(condition, id, ...)                                                                  \
    do {                                                                                                     \
        if (!(condition)) [[unlikely]]                                                                       \
            ::tappet::contract_broken<id>(__VA_ARGS__);                                                      \
    } while (false)

/// As TAPPET_CONTRACT, for checks of the calling thread on paths with published times: in sanitizer builds
/// only.
#ifdef TAPPET_ASSERTS_THREADS
#define TAPPET_THREAD_CONTRACT(condition, id, ...) TAPPET_CONTRACT(condition, id __VA_OPT__(, ) __VA_ARGS__)
#else
#define TAPPET_THREAD_CONTRACT(condition, id, ...) static_cast<void>(0)
#endif
