// The output of the script compiler: rows into the room, values into the data's image, and the first fault.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/program/operators.hpp"
#include "kernel/script/room.hpp"
#include "kernel/script/token.hpp"

#include <initializer_list>

namespace tappet {

/// Limit for nested expressions, statements and functions, counted together.
inline constexpr std::uint32_t script_max_depth = 32;
/// Most tokens read to compile a text of so many characters; more would mean functions that multiply.
constexpr std::uint64_t script_work(std::size_t characters) noexcept {
    return 16 * std::uint64_t{characters} + 4096;
}

namespace script_detail {

/// While a type is compiled its values have places within one of four regions; when it is complete the
/// regions are concatenated and the places become offsets.
enum class Region : std::uint8_t { constants, variables, arguments, scratch };
inline constexpr unsigned region_bits = 14;
inline constexpr std::uint32_t region_bytes = (1u << region_bits) - 16;

constexpr Region region_of(DataOffset place) noexcept { return static_cast<Region>(place >> region_bits); }
constexpr std::uint32_t within(DataOffset place) noexcept { return place & ((1u << region_bits) - 1); }

constexpr std::uint32_t aligned(std::uint32_t bytes, std::uint32_t to = 8) noexcept {
    return (bytes + to - 1) / to * to;
}

/// Rows of one kind: those of earlier types, then those of the current type.
template <class Row>
struct Rows {
    std::span<Row> room{};
    std::uint32_t used = 0;
    std::uint32_t base = 0;

    [[nodiscard]] constexpr std::uint32_t count() const noexcept { return used - base; }
    constexpr Row& operator[](std::size_t i) const noexcept { return room[base + i]; }
    [[nodiscard]] constexpr std::span<Row> view() const noexcept { return room.subspan(base, used - base); }
};

class Output {
public:
    constexpr Output(std::string_view text, std::string_view file, const Reach& reach, const ScriptRoom& room,
                     ScriptOutcome& outcome)
        : reach_{reach},
          room_{room},
          outcome_{outcome},
          file_{file},
          lexer_{text},
          work_{script_work(text.size())} {
        instructions_.room = room.instructions;
        conditions_.room = room.conditions;
        nodes_.room = room.nodes;
        arcs_.room = room.arcs;
        programs_.room = room.programs;
        variables_.room = room.variables;
        links_.room = room.links;
        states_.room = room.states;
        transitions_.room = room.transitions;
        captures_.room = room.captures;
        types_.room = room.types;
        instances_.room = room.instances;
    }

protected:
    // ---- faults: the first one counts and ends the reading of tokens

    [[nodiscard]] constexpr bool ok() const noexcept { return !failed_; }
    constexpr void fail(const Token& at, std::initializer_list<std::string_view> pieces) {
        if (failed_) return;
        failed_ = true;
        outcome_.line = at.line;
        outcome_.column = at.column;
        Sentence& s = outcome_.fault;
        s.add(file_).add(":").add(std::int64_t{at.line}).add(":").add(std::int64_t{at.column}).add(": ");
        for (const std::string_view piece : pieces) s.add(piece);
        token_.sign = Sign::end;
    }
    /// Reports "found this, expected that".
    constexpr void fail_expected(std::string_view wanted) {
        if (token_.sign == Sign::broken) return fail(token_, {"found ", token_.fault, "; expected ", wanted});
        if (token_.sign == Sign::end) return fail(token_, {"found the end of the text, expected ", wanted});
        fail(token_, {"found \"", quoted(token_.text), "\", expected ", wanted});
    }
    constexpr void fail_unknown(const Token& at, std::string_view what, const Nearest& nearest,
                                std::string_view where) {
        if (nearest.best().empty())
            return fail(at, {"found ", what, " \"", quoted(at.text), "\", which is not known", where});
        fail(at, {"found ", what, " \"", quoted(at.text), "\", which is not known", where,
                  "; did you mean \"", nearest.best(), "\"?"});
    }
    constexpr void fail_room(std::string_view what) {
        if (failed_) return;
        fail(token_,
             {"the script needs more ", what, " than there is room for; make it smaller or the room larger"});
        outcome_.out_of_room = true;
    }
    /// Converts a number for a sentence; valid until the second call after it.
    constexpr std::string_view digits(std::uint64_t number) {
        std::array<char, 20>& into = digits_[digits_used_++ % digits_.size()];
        std::size_t at = into.size();
        do into[--at] = static_cast<char>('0' + number % 10);
        while ((number /= 10) != 0);
        return {into.data() + at, into.size() - at};
    }
    /// Reports a limit that a larger room does not raise.
    constexpr void fail_limit(std::string_view what) {
        fail(token_, {"the script needs more ", what, " than the language allows; make it smaller"});
    }
    static constexpr std::string_view quoted(std::string_view text) noexcept { return text.substr(0, 60); }

    // ---- tokens

    constexpr void advance() {
        if (failed_) {
            token_.sign = Sign::end;
            return;
        }
        if (work_ == 0)
            return fail(token_, {"the functions of this script expand to more text than the compiler reads; "
                                 "call fewer functions in functions"});
        --work_;
        lexer_.next(token_);
    }
    [[nodiscard]] constexpr bool is(Sign sign) const noexcept { return token_.sign == sign; }
    constexpr bool take(Sign sign) {
        if (token_.sign != sign) return false;
        advance();
        return true;
    }
    constexpr bool need(Sign sign, std::string_view wanted) {
        if (take(sign)) return true;
        fail_expected(wanted);
        return false;
    }
    /// Reads a name that the script defines; keywords are refused.
    constexpr Token need_name(std::string_view wanted) {
        const Token name = token_;
        if (!is(Sign::name))
            fail_expected(wanted);
        else
            advance();
        return name;
    }
    /// Reads a name after a dot or in an interface, where keywords are names too.
    constexpr Token need_word(std::string_view wanted) {
        const Token name = token_;
        if (!token_.is_word())
            fail_expected(wanted);
        else
            advance();
        return name;
    }
    struct Place {
        Lexer lexer;
        Token token;
    };
    [[nodiscard]] constexpr Place here() const noexcept { return {lexer_, token_}; }
    constexpr void go_to(const Place& place) {
        if (failed_) return;
        lexer_ = place.lexer;
        token_ = place.token;
    }

    // ---- rows

    template <class Row>
    constexpr std::uint16_t add(Rows<Row>& rows, const Row& row, std::string_view what) {
        if (rows.used == rows.room.size() || rows.count() >= 0xfff0) {
            fail_room(what);
            return 0;
        }
        rows.room[rows.used++] = row;
        return static_cast<std::uint16_t>(rows.count() - 1);
    }
    constexpr void emit(const Instruction& instruction) {
        if (ok()) add(instructions_, instruction, "instructions");
    }
    [[nodiscard]] constexpr std::uint16_t instruction_count() const noexcept {
        return static_cast<std::uint16_t>(instructions_.count());
    }
    constexpr Instruction& last_instruction() noexcept { return instructions_[instructions_.count() - 1]; }

    /// Copies characters so that they outlive the text.
    constexpr std::string_view keep(std::initializer_list<std::string_view> pieces) {
        const std::size_t from = names_used_;
        for (const std::string_view piece : pieces) {
            if (room_.names.size() - names_used_ < piece.size()) {
                fail_room("characters of names");
                return {};
            }
            std::copy_n(piece.data(), piece.size(), room_.names.data() + names_used_);
            names_used_ += piece.size();
        }
        return {room_.names.data() + from, names_used_ - from};
    }

    // ---- data

    constexpr DataOffset place_in(Region region, std::size_t size) {
        std::uint32_t& used = region_used_[static_cast<std::size_t>(region)];
        const std::uint32_t at = used;
        if (size > region_bytes || at + aligned(static_cast<std::uint32_t>(size)) > region_bytes) {
            fail_limit(region == Region::constants ? "constants" : "data");
            return 0;
        }
        used = at + aligned(static_cast<std::uint32_t>(size));
        if (region == Region::scratch) scratch_most_ = std::max(scratch_most_, used);
        return static_cast<DataOffset>(static_cast<std::uint32_t>(region) << region_bits | at);
    }
    constexpr DataOffset scratch(std::size_t size) { return place_in(Region::scratch, size); }
    static constexpr DataOffset moved(DataOffset place, std::size_t by) noexcept {
        return static_cast<DataOffset>(place + by);
    }

    /// Allocates zero bytes for a constant; null: no room.
    constexpr std::byte* add_constant(std::size_t size, DataOffset& at) {
        at = place_in(Region::constants, size);
        const std::size_t end = within(at) + aligned(static_cast<std::uint32_t>(size));
        if (ok() && image_base_ + end + region_used(Region::variables) > room_.image.size())
            fail_room("constants");
        if (!ok()) return nullptr;
        std::byte* const bytes = room_.image.data() + image_base_ + within(at);
        for (std::size_t i = 0; i < aligned(static_cast<std::uint32_t>(size)); ++i) bytes[i] = std::byte{0};
        note_image();
        return bytes;
    }
    [[nodiscard]] constexpr const std::byte* constant_bytes(DataOffset at) const noexcept {
        return room_.image.data() + image_base_ + within(at);
    }
    /// Adds a constant of at most 8 bytes, low byte first; equal constants share a place.
    constexpr DataOffset small_constant(std::uint64_t bits, std::size_t size) {
        std::uint16_t& head = constant_heads_[(bits ^ (bits >> 32) ^ (bits >> 54)) % constant_heads_.size()];
        for (std::uint16_t i = head; i != 0; i = constants_[i - 1].next)
            if (constants_[i - 1].bits == bits) return constants_[i - 1].at;
        DataOffset at = 0;
        std::byte* const bytes = add_constant(8, at);
        if (bytes == nullptr) return 0;
        for (std::size_t i = 0; i < std::max<std::size_t>(size, 8); ++i)
            bytes[i] = static_cast<std::byte>(bits >> (8 * i));
        if (constants_used_ < constants_.size()) {
            constants_[constants_used_++] = {bits, at, head};
            head = static_cast<std::uint16_t>(constants_used_);
        }
        return at;
    }
    /// Allocates initial bytes of a variable; they stay at the end of the room, the first variable last,
    /// until all constants are known. Null: no room.
    constexpr std::byte* add_variable(std::size_t size, DataOffset& at) {
        at = place_in(Region::variables, size);
        const std::size_t end = region_used(Region::variables);
        if (ok() && image_base_ + region_used(Region::constants) + end > room_.image.size())
            fail_room("variables");
        if (!ok()) return nullptr;
        std::byte* const bytes = room_.image.data() + room_.image.size() - end;
        for (std::size_t i = 0; i < aligned(static_cast<std::uint32_t>(size)); ++i) bytes[i] = std::byte{0};
        note_image();
        return bytes;
    }
    [[nodiscard]] constexpr std::uint32_t region_used(Region region) const noexcept {
        return region_used_[static_cast<std::size_t>(region)];
    }
    constexpr void note_image() noexcept {
        image_most_ = std::max(image_most_, image_base_ + region_used(Region::constants) +
                                                2 * region_used(Region::variables));
    }

    // ---- a type: its rows begin after those of the earlier types

    constexpr void begin_type() {
        instructions_.base = instructions_.used;
        conditions_.base = conditions_.used;
        nodes_.base = nodes_.used;
        arcs_.base = arcs_.used;
        programs_.base = programs_.used;
        variables_.base = variables_.used;
        links_.base = links_.used;
        states_.base = states_.used;
        transitions_.base = transitions_.used;
        captures_.base = captures_.used;
        image_base_ = aligned(image_base_, data_alignment);
        region_used_ = {};
        scratch_most_ = 0;
        constant_heads_ = {};
        constants_used_ = 0;
    }
    constexpr void lay_out(ProgramTables& tables) {
        const std::uint32_t constants = aligned(region_used(Region::constants), data_alignment);
        const std::uint32_t variables = constants + aligned(region_used(Region::variables), data_alignment);
        const std::uint32_t arguments = variables + aligned(region_used(Region::arguments), data_alignment);
        const std::uint32_t size = arguments + aligned(scratch_most_, data_alignment);
        if (size > 0xff00) return fail_limit("data");
        image_most_ = std::max(image_most_, image_base_ + constants + 2 * (variables - constants));
        if (image_most_ > room_.image.size()) return fail_room("bytes of initial data");
        for (const VariableRow& row : variables_.view()) {
            if (region_of(row.at) != Region::variables) continue;
            const std::size_t at = within(row.at),
                              bytes = aligned(static_cast<std::uint32_t>(row.type->size));
            std::copy_n(room_.image.data() + room_.image.size() - at - bytes, bytes,
                        room_.image.data() + image_base_ + constants + at);
        }
        const std::uint32_t begin[] = {0, constants, variables, arguments};
        const auto put = [&begin](DataOffset& place) {
            if (place != no_data)
                place = static_cast<DataOffset>(begin[static_cast<std::size_t>(region_of(place))] +
                                                within(place));
        };
        for (Instruction& in : instructions_.view()) put(in.to), put(in.a), put(in.b);
        for (ConditionRow& row : conditions_.view()) put(row.result);
        for (ArcRow& row : arcs_.view()) put(row.after);
        for (VariableRow& row : variables_.view()) put(row.at);
        for (CaptureRow& row : captures_.view()) put(row.raw);
        tables.instructions = instructions_.view();
        tables.conditions = conditions_.view();
        tables.nodes = nodes_.view();
        tables.arcs = arcs_.view();
        tables.programs = programs_.view();
        tables.variables = variables_.view();
        tables.links = links_.view();
        tables.image = room_.image.subspan(image_base_, variables);
        tables.layout = {static_cast<DataOffset>(constants), static_cast<DataOffset>(variables),
                         static_cast<DataOffset>(arguments), static_cast<DataOffset>(size)};
        image_base_ += variables;
    }
    constexpr void note_sizes() {
        ScriptSizes& s = outcome_.sizes;
        s.instructions = instructions_.used;
        s.conditions = conditions_.used;
        s.nodes = nodes_.used;
        s.arcs = arcs_.used;
        s.programs = programs_.used;
        s.variables = variables_.used;
        s.links = links_.used;
        s.image = aligned(std::max(image_most_, image_base_), data_alignment);
        s.states = states_.used;
        s.transitions = transitions_.used;
        s.captures = captures_.used;
        s.types = types_.used;
        s.instances = instances_.used;
        s.names = static_cast<std::uint32_t>(names_used_);
        s.reach = static_cast<std::uint32_t>(reach_.components.size());
    }

    struct SharedConstant {
        std::uint64_t bits = 0;
        DataOffset at = 0;
        std::uint16_t next = 0; // 1 + number in the list
    };

    const Reach& reach_;
    const ScriptRoom& room_;
    ScriptOutcome& outcome_;
    std::string_view file_;
    Lexer lexer_;
    Token token_{};
    std::uint64_t work_;
    std::array<std::array<char, 20>, 2> digits_{};
    std::size_t digits_used_ = 0;
    bool failed_ = false;
    Rows<Instruction> instructions_{};
    Rows<ConditionRow> conditions_{};
    Rows<NodeRow> nodes_{};
    Rows<ArcRow> arcs_{};
    Rows<ProgramRow> programs_{};
    Rows<VariableRow> variables_{};
    Rows<LinkRow> links_{};
    Rows<StateRow> states_{};
    Rows<TransitionRow> transitions_{};
    Rows<CaptureRow> captures_{};
    Rows<BehaviourType> types_{};
    Rows<BehaviourInstance> instances_{};
    std::array<std::uint32_t, 4> region_used_{};
    std::uint32_t scratch_most_ = 0;
    std::uint32_t image_base_ = 0; // beginning of the type's image
    std::uint32_t image_most_ = 0;
    std::size_t names_used_ = 0;
    std::array<SharedConstant, 256> constants_{};
    std::array<std::uint16_t, 128> constant_heads_{};
    std::size_t constants_used_ = 0;
};

} // namespace script_detail

} // namespace tappet
