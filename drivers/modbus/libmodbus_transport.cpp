// libmodbus's calls, with its time-outs and errors returned as values.
#include "drivers/modbus/libmodbus_transport.hpp"

#include "kernel/os/sleep.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <modbus.h>
#include <string>
#include <sys/select.h>
#include <sys/socket.h>
#include <time.h>

namespace tappet::modbus {
namespace {

constexpr std::size_t most_values = MODBUS_MAX_READ_REGISTERS;
constexpr std::size_t most_in_write = MODBUS_MAX_WRITE_REGISTERS;

Time now() noexcept {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return at_ns(std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec);
}

Answer judge(int result, int expected, int error, Duration took) noexcept {
    if (result == expected) return {.took = took};
    if (result >= 0) return {.outcome = Outcome::garbled, .took = took};
    if (error > MODBUS_ENOBASE && error <= EMBXGTAR)
        return {.outcome = Outcome::exception,
                .exception = static_cast<std::uint8_t>(error - MODBUS_ENOBASE),
                .took = took};
    if (error > EMBXGTAR && error <= EMBBADSLAVE) return {.outcome = Outcome::garbled, .took = took};
    return {.outcome = error == ETIMEDOUT ? Outcome::timeout : Outcome::disconnected, .took = took};
}

std::expected<modbus_t*, Sentence> prepare(const Tcp& tcp) {
    const std::string address{tcp.address};
    in_addr parsed{};
    if (::inet_pton(AF_INET, address.c_str(), &parsed) != 1 || tcp.port == 0)
        return std::unexpected{Sentence{
            "Modbus server \"", tcp.address, "\", port ", unsigned{tcp.port},
            ": this is not a numeric IPv4 address and port; write it like \"192.168.0.7\" in the board"}};
    return modbus_new_tcp(address.c_str(), tcp.port);
}

std::expected<modbus_t*, Sentence> prepare(const Serial& serial) {
    const bool known_parity = serial.parity == 'N' || serial.parity == 'E' || serial.parity == 'O';
    if (serial.device.empty() || !known_parity || serial.baud < 1200 || serial.stop_bits < 1 ||
        serial.stop_bits > 2)
        return std::unexpected{Sentence{
            "Modbus line \"", serial.device, "\", ", serial.baud, " baud, parity ",
            std::string_view{&serial.parity, 1}, ", ", serial.stop_bits,
            " stop bits: not possible; write 1200 baud or more, parity N, E or O, 1 or 2 stop bits"}};
    return modbus_new_rtu(std::string{serial.device}.c_str(), serial.baud, serial.parity, 8,
                          serial.stop_bits);
}

/// Returns the time of 3.5 characters of 11 bits; above 19200 baud always 1.75 ms.
Duration silence_of(const Serial& serial) noexcept {
    return serial.baud > 19200 ? Duration{1750us} : Duration{1s} * 77 / 2 / serial.baud;
}

bool set_answer_time(modbus_t* context, Duration time) noexcept {
    return modbus_set_response_timeout(context, static_cast<std::uint32_t>(time / 1s),
                                       static_cast<std::uint32_t>(time % 1s / 1us)) == 0;
}

/// Replaces modbus_write_bits() and modbus_write_registers(), which accept a confirmation of another address.
/// On a serial line only the address shows which request an answer belongs to.
int write_on_serial(modbus_t* m, Table table, std::uint16_t address,
                    std::span<const std::uint16_t> values) noexcept {
    const std::size_t bytes = table == Table::coils ? (values.size() + 7) / 8 : 2 * values.size();
    const auto low = [](std::size_t number) { return static_cast<std::uint8_t>(number & 0xFF); };
    std::array<std::uint8_t, 7 + 2 * most_in_write> request{
        low(static_cast<std::size_t>(modbus_get_slave(m))),
        low(function_code(table, true)),
        low(address >> 8u),
        low(address),
        0,
        low(values.size()),
        low(bytes)};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (table == Table::coils) {
            request[7 + i / 8] = low(request[7 + i / 8] | (values[i] != 0 ? 1u << i % 8 : 0u));
        } else {
            request[7 + 2 * i] = low(values[i] >> 8u);
            request[8 + 2 * i] = low(values[i]);
        }
    }
    if (modbus_send_raw_request(m, request.data(), static_cast<int>(7 + bytes)) < 0) return -1;
    std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> answer{};
    const int got = modbus_receive_confirmation(m, answer.data());
    if (got < 0) return -1;
    if (got == 8 && std::equal(answer.begin(), answer.begin() + 6, request.begin()))
        return static_cast<int>(values.size());
    const bool refuses = got == 5 && answer[0] == request[0] && answer[1] == (request[1] | 0x80) &&
                         answer[2] != 0 && answer[2] < MODBUS_EXCEPTION_MAX;
    errno = refuses ? MODBUS_ENOBASE + answer[2] : EMBBADDATA;
    return -1;
}

} // namespace

void LibmodbusTransport::Free::operator()(_modbus* context) const noexcept { modbus_free(context); }

std::expected<void, Sentence> LibmodbusTransport::open(const TransportSettings& settings) {
    close();
    is_serial_ = std::holds_alternative<Serial>(settings.line);
    const int most_unit = is_serial_ ? 247 : 255;
    if (settings.unit < 1 || settings.unit > most_unit)
        return std::unexpected{Sentence{"Modbus unit ", settings.unit, " does not exist: choose 1 to ",
                                        most_unit, " in the board"}};
    const auto prepared = std::visit([](const auto& line) { return prepare(line); }, settings.line);
    if (!prepared) return std::unexpected{prepared.error()};
    context_.reset(*prepared);
    answer_within_ = limit_ = settings.answer_within;
    silence_ = is_serial_ ? silence_of(std::get<Serial>(settings.line)) : Duration{};
    quiet_until_ = {};
    modbus_t* m = context_.get();
    const bool ok = m != nullptr && modbus_set_slave(m, settings.unit) == 0 &&
                    modbus_set_error_recovery(m, MODBUS_ERROR_RECOVERY_NONE) == 0 &&
                    set_answer_time(m, answer_within_) &&
                    // A byte time-out would restart with each byte. Without one, libmodbus applies the time
                    // above to the whole answer.
                    modbus_set_byte_timeout(m, 0, 0) == 0;
    if (ok) return {};
    close();
    return std::unexpected{Sentence{"Modbus unit ", settings.unit, " cannot be set up: ",
                                    modbus_strerror(errno), "; its time-out must be above 1 us"}};
}

void LibmodbusTransport::wait_at_most(Duration limit) noexcept {
    limit_ = std::min(std::max<Duration>(limit, 1ms), answer_within_);
    ends_ = now() + std::max<Duration>(limit, 1ms);
    if (context_) static_cast<void>(set_answer_time(context_.get(), limit_));
}

void LibmodbusTransport::close() noexcept {
    disconnect();
    context_.reset();
}

Answer LibmodbusTransport::connect() noexcept {
    belongs_to_.used();
    if (!context_) return {.outcome = Outcome::refused};
    disconnect();
    const Time begin = now();
    connected_ = modbus_connect(context_.get()) == 0;
    // libmodbus waits by select(), which cannot watch a higher descriptor.
    if (connected_ && (modbus_get_socket(context_.get()) >= FD_SETSIZE || !forgets_what_is_lost()))
        disconnect();
    return {.outcome = connected_ ? Outcome::ok : Outcome::refused, .took = now() - begin};
}

/// Makes the close of a connection discard an unanswered request, also at the end of this process. An orderly
/// close is wrong here: the kernel would still deliver the request, after newer ones.
bool LibmodbusTransport::forgets_what_is_lost() const noexcept {
    const linger at_once{.l_onoff = 1, .l_linger = 0};
    return is_serial_ || ::setsockopt(modbus_get_socket(context_.get()), SOL_SOCKET, SO_LINGER, &at_once,
                                      sizeof at_once) == 0;
}

void LibmodbusTransport::disconnect() noexcept {
    if (connected_) modbus_close(context_.get());
    connected_ = false;
}

bool LibmodbusTransport::recover() noexcept {
    belongs_to_.used();
    // On TCP a late answer would be taken for the next request's; a serial line only needs to be emptied.
    if (is_serial_ && connected_ && modbus_flush(context_.get()) >= 0) return true;
    disconnect();
    return false;
}

bool LibmodbusTransport::settle() noexcept {
    if (!is_serial_) return true;
    const Time until = std::min(quiet_until_, ends_);
    for (Time at = now(); at < until; at = now()) os::sleep_for(until - at);
    if (until < quiet_until_) return false;
    if (ends_ != never)
        static_cast<void>(set_answer_time(context_.get(), std::clamp<Duration>(ends_ - now(), 1ms, limit_)));
    static_cast<void>(modbus_flush(context_.get())); // drops bytes of an earlier request
    return true;
}

Answer LibmodbusTransport::end(int result, int expected, int error, Time began) noexcept {
    const Time ended = now();
    const Answer answer = judge(result, expected, error, ended - began);
    const bool is_answered = answer.outcome == Outcome::ok || answer.outcome == Outcome::exception;
    quiet_until_ = ended + (is_answered ? silence_ : limit_);
    return answer;
}

Answer LibmodbusTransport::read(Table table, std::uint16_t address,
                                std::span<std::uint16_t> values) noexcept {
    belongs_to_.used();
    if (!connected_ || values.empty() || values.size() > most_values)
        return {.outcome = Outcome::disconnected};
    const int count = static_cast<int>(values.size());
    modbus_t* m = context_.get();
    std::array<std::uint8_t, most_values> bits{};
    const Time begin = now();
    if (!settle()) return {.outcome = Outcome::timeout, .took = now() - begin};
    int result = -1;
    switch (table) {
    case Table::coils: result = modbus_read_bits(m, address, count, bits.data()); break;
    case Table::discrete_inputs: result = modbus_read_input_bits(m, address, count, bits.data()); break;
    case Table::input_registers:
        result = modbus_read_input_registers(m, address, count, values.data());
        break;
    case Table::holding_registers: result = modbus_read_registers(m, address, count, values.data()); break;
    }
    const int error = errno;
    if (holds_bits(table) && result == count)
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = bits[i];
    return end(result, count, error, begin);
}

Answer LibmodbusTransport::write(Table table, std::uint16_t address,
                                 std::span<const std::uint16_t> values) noexcept {
    belongs_to_.used();
    if (!connected_ || values.empty() || values.size() > most_in_write || !writable(table))
        return {.outcome = Outcome::disconnected};
    const int count = static_cast<int>(values.size());
    std::array<std::uint8_t, most_values> bits{};
    const Time begin = now();
    if (!settle()) return {.outcome = Outcome::timeout, .took = now() - begin};
    int result = -1;
    if (is_serial_) {
        result = write_on_serial(context_.get(), table, address, values);
    } else if (table == Table::coils) {
        for (std::size_t i = 0; i < values.size(); ++i) bits[i] = values[i] != 0 ? 1 : 0;
        result = modbus_write_bits(context_.get(), address, count, bits.data());
    } else {
        result = modbus_write_registers(context_.get(), address, count, values.data());
    }
    const int error = errno;
    return end(result, count, error, begin);
}

} // namespace tappet::modbus
