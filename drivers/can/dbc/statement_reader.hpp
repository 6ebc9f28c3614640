// Ends of statements of a DBC file, and the rows that statements are about, by identifier and name.
#pragma once

#include "drivers/can/dbc/message_reader.hpp"

namespace tappet::can::dbc {

class StatementReader : protected MessageReader {
protected:
    using MessageReader::MessageReader;

    /// Returns whether to skip the statement, because it has no effect on the wire.
    static bool is_passed_over(std::string_view keyword) noexcept {
        constexpr std::string_view all =
            "VAL_TABLE_ EV_ ENVVAR_DATA_ EV_DATA_ SGTYPE_ SIG_GROUP_ SIG_TYPE_REF_ SIGTYPE_VALTYPE_ "
            "SGTYPE_VAL_ "
            "BA_DEF_SGTYPE_ BA_SGTYPE_ BA_DEF_REL_ BA_REL_ BA_DEF_DEF_REL_ BU_SG_REL_ BU_EV_REL_ "
            "BU_BO_REL_ CAT_ CAT_DEF_ FILTER CM_ NS_DESC_";
        return names(all, keyword);
    }
    static bool is_statement(std::string_view keyword) noexcept {
        constexpr std::string_view read =
            "BO_ SG_ VAL_ BA_ BA_DEF_ BA_DEF_DEF_ BO_TX_BU_ SIG_VALTYPE_ SG_MUL_VAL_ BU_ NS_ BS_ VERSION";
        return names(read, keyword) || is_passed_over(keyword);
    }
    static bool begins_statement(const Scanner& at) noexcept {
        return at.begins_line() && is_statement(at.peek());
    }
    void end_of_statement() {
        if (!ok() || in_.take(';')) return;
        if (in_.at_end() || !begins_statement(in_)) return fail_expected("\";\", the end of the statement");
        note(statement_at_, "the statement has no \";\"; it ends before the next one");
    }
    void skip_statement() {
        std::size_t text_at = 0;
        switch (in_.skip_statement(is_statement, text_at)) {
        case Scanner::End::semicolon: break;
        case Scanner::End::none:
            if (!failed_) note(statement_at_, "the statement has no \";\"; it ends before the next one");
            break;
        case Scanner::End::inside:
            give_up(in_.at(), "found \"", in_.found(), "\", expected \";\" before it");
            break;
        case Scanner::End::unclosed: give_up(text_at, "a text is unclosed before the next statement"); break;
        case Scanner::End::cut:
            give_up(text_at, text_at == net_.text.size()
                                 ? "the file ends, expected \";\", the end of a statement; is it whole?"
                                 : "a text is unclosed at the end of the file; is it whole?");
        }
    }

    // ---- look-up of the row that a statement is about: false after a fault, and in Vector's container

    template <class... Pieces> void spoil_unknown(std::size_t at, const Pieces&... pieces) {
        if (weight_ == Weight::note) return note(at, pieces...);
        fail(at, pieces...);
    }
    /// `marks`: a fault of the statement behind the identifier spoils the message, not the file.
    bool known_message(bool marks) {
        const std::size_t at = in_.at();
        const std::uint32_t id = whole(0xffff'ffff, "a message's identifier");
        if (!ok()) return false;
        message_ = message_of(id);
        if (message_ != no_such) {
            is_by_identifier_ = true;
            marks_ = marks;
            return true;
        }
        bool is_independent = id == independent_id;
        for (const MessageRow& each : net_.messages)
            is_independent |= each.is_independent && raw_id(each) == id;
        if (!is_independent) spoil_unknown(at, "no message has the identifier ", std::uint64_t{id});
        failed_ = true;
        return false;
    }
    /// Finds it in the first of the messages with the identifier that has it.
    bool known_signal() {
        const std::size_t at = in_.at();
        const std::string_view name = label("a signal's name");
        if (!ok()) return false;
        const SignalRow* found = nullptr;
        for_each_twin([&](const MessageRow& each) {
            if (found == nullptr) found = net_.find(each, name);
        });
        if (found != nullptr) {
            about(*found);
            return true;
        }
        Nearest nearest{name};
        for (const SignalRow& each : net_.of(the_message())) nearest.consider(each.shape.name);
        spoil_unknown(at, "message \"", the_message().name, "\" has no signal \"", name, "\"",
                      or_meant(nearest, ""));
        failed_ = true;
        return false;
    }
};

} // namespace tappet::can::dbc
