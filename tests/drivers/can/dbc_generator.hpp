// Random valid DBC files: both byte orders, signs, floats, multiplexors of both kinds, names of values, code
// page 1252, cycle times. The same seed gives the same text everywhere.
#pragma once

#include "kernel/base/random.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::can {

class DbcGenerator {
public:
    explicit DbcGenerator(std::uint64_t seed) : random_{seed} {}

    /// Nodes "us", "them" and "others"; messages of each.
    std::string file() {
        text_ = "VERSION \"" + std::to_string(below(100)) +
                "\"\n\nNS_ :\n\tCM_\n\tBA_\n\nBS_:\n\nBU_: us them others\n\n";
        is_fd_ = random_.one_in(3);
        tail_ =
            "CM_ \"generated: \\\"BO_ 1\\\"\";\nBA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_DEF_DEF_ "
            "\"GenMsgCycleTime\" 0;\n";
        if (is_fd_) tail_ += fd_attributes();
        own.clear();
        const std::size_t messages = 1 + below(8);
        for (std::size_t m = 0; m < messages; ++m) message(m);
        if (random_.one_in(3))
            text_ += "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ idle : 0|8@1+ (1,0) "
                     "[0|0] \"\" us\n\n";
        return text_ + tail_;
    }

    std::vector<std::string> own{}; ///< messages that "us" sends in the last file

private:
    using Places = std::array<bool, 512>;

    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_.below(n)); }
    template <std::size_t N> std::string any(const std::string_view (&list)[N]) {
        return std::string{list[below(N)]};
    }

    void message(std::size_t m) {
        const bool is_extended = random_.one_in(3);
        id_ = m * 200 + below(200) + (is_extended ? 0x8000'0000u + (below(0x1000) << 16) : 0);
        constexpr std::size_t fd_lengths[] = {1, 3, 8, 12, 16, 20, 24, 32, 48, 64};
        const bool has_fd = is_fd_ && !random_.one_in(3);
        bytes_ = has_fd ? fd_lengths[below(std::size(fd_lengths))] : 1 + below(8);
        const std::string name = "Message_" + std::to_string(m);
        const std::string sender = any({"us", "them", "them", "others", "Vector__XXX"});
        text_ += "BO_ " + std::to_string(id_) + ' ' + name + (random_.one_in(2) ? ": " : " : ") +
                 std::to_string(bytes_) + ' ' + sender + '\n';
        used_ = {};
        signals_ = 0;
        lines_.clear();
        const std::size_t kind = bytes_ < 3 ? 0 : below(3);
        if (kind == 1) pages();
        if (kind == 2) nested_pages();
        for (std::size_t more = 1 + below(6); more != 0; --more) signal("", used_);
        // A signal may stand before its multiplexor.
        for (std::size_t i = lines_.size(); i > 1; --i) std::swap(lines_[i - 1], lines_[below(i)]);
        for (const std::string& line : lines_) text_ += line;
        text_ += '\n';
        if (sender == "us") own.push_back(name);
        tail_ += "BA_ \"GenMsgCycleTime\" BO_ " + std::to_string(id_) + ' ' + std::to_string(1 + below(500)) +
                 ";\n";
        if (has_fd) tail_ += format_of(is_extended);
        if (random_.one_in(4)) tail_ += "BO_TX_BU_ " + std::to_string(id_) + " : them,others;\n";
    }
    static std::string fd_attributes() {
        std::string all = "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",";
        for (int i = 2; i < 14; ++i) all += i == 3 ? "\"J1939PG\"," : "\"reserved\",";
        return all + "\"StandardCAN_FD\",\"ExtendedCAN_FD\";\nBA_DEF_ BO_ \"CANFD_BRS\" ENUM \"0\",\"1\";\n"
                     "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\nBA_DEF_DEF_ \"CANFD_BRS\" \"1\";\n";
    }
    std::string format_of(bool is_extended) {
        std::string says =
            "BA_ \"VFrameFormat\" BO_ " + std::to_string(id_) + (is_extended ? " 15;\n" : " 14;\n");
        if (random_.one_in(2))
            says += "BA_ \"CANFD_BRS\" BO_ " + std::to_string(id_) + (random_.one_in(2) ? " 0;\n" : " 1;\n");
        return says;
    }
    /// One multiplexor, M, and pages m0 and on.
    void pages() {
        if (multiplexor("M", used_).empty()) return;
        pages_ = used_;
        for (std::size_t page = 0, last = 1 + below(5); page <= last; ++page) {
            Places places = used_;
            for (std::size_t more = 1 + below(3); more != 0; --more)
                signal("m" + std::to_string(page), places);
            used_or_page(places);
        }
        used_ = pages_;
    }
    /// M, a second one among its pages, and ranges for all multiplexed signals.
    void nested_pages() {
        const std::string outer = multiplexor("M", used_);
        if (outer.empty()) return;
        pages_ = used_;
        Places second = used_;
        const std::string inner = multiplexor("m9M", second);
        if (!inner.empty()) select(inner, outer, "8-9, 11-12");
        for (std::size_t page = 0; page < 3; ++page) {
            Places places = used_;
            for (std::size_t more = 1 + below(2); more != 0; --more)
                if (const std::string name = signal("m" + std::to_string(page), places); !name.empty())
                    select(name, outer,
                           std::to_string(page) + '-' + std::to_string(page) +
                               (random_.one_in(2)
                                    ? ", " + std::to_string(4 + page) + '-' + std::to_string(4 + page)
                                    : ""));
            used_or_page(places);
        }
        for (std::size_t page = 0; page < 3 && !inner.empty(); ++page) {
            Places places = second;
            if (const std::string name = signal("m" + std::to_string(page), places); !name.empty())
                select(name, inner, std::to_string(4 * page) + '-' + std::to_string(4 * page + 3));
            used_or_page(places);
        }
        used_ = pages_;
    }
    void used_or_page(const Places& places) {
        for (std::size_t i = 0; i < places.size(); ++i) pages_[i] = pages_[i] || places[i];
    }
    void select(const std::string& name, const std::string& by, const std::string& ranges) {
        tail_ += "SG_MUL_VAL_ " + std::to_string(id_) + ' ' + name + ' ' + by + ' ' + ranges + ";\n";
    }

    std::string multiplexor(const std::string& word, Places& places) {
        return add(word, places, 4, false, "(1,0)", "");
    }
    std::string signal(const std::string& word, Places& places) {
        static constexpr std::string_view factors[] = {"1",   "1",      "0.1",     "0.001", "1E-05", "-0.5",
                                                       "2.5", "0.0625", "123.456", "3e2",   ".25"};
        static constexpr std::string_view offsets[] = {"0", "0", "-40", "100.25", "-1E3", "0.7"};
        const std::size_t bits = random_.one_in(4) ? 1 + below(64) : 1 + below(16);
        const std::string factor = random_.one_in(4)
                                       ? std::to_string(1 + below(99999)) + "E-" + std::to_string(below(9))
                                       : any(factors);
        const std::string scale =
            "(" + factor + (word.empty() && random_.one_in(4) ? ", " : ",") + any(offsets) + ")";
        if (random_.one_in(6)) {
            const bool is_double = random_.one_in(3);
            const std::string name =
                add(word, places, is_double ? 64 : 32, true, scale, is_double ? "2" : "1");
            if (!name.empty()) return name;
        }
        return add(word, places, bits, random_.one_in(2), scale, "");
    }
    /// Returns empty when there was no room.
    std::string add(const std::string& word, Places& places, std::size_t bits, bool is_signed,
                    const std::string& scale, const std::string& value_type) {
        for (int tries = 0; tries < 12;
             ++tries, bits = value_type.empty() && word.find('M') == word.npos ? 1 + bits / 2 : bits) {
            const bool is_intel = random_.one_in(2);
            const std::size_t first = below(8 * bytes_); // counted in the signal's own bit order
            if (first + bits > 8 * bytes_) continue;
            bool is_free = true;
            const auto place = [&](std::size_t i) { return is_intel ? i : 8 * (i / 8) + 7 - i % 8; };
            for (std::size_t i = first; i < first + bits; ++i) is_free = is_free && !places[place(i)];
            if (!is_free) continue;
            for (std::size_t i = first; i < first + bits; ++i) places[place(i)] = true;
            const std::string name = "Signal_" + std::to_string(signals_++);
            static constexpr std::string_view units[] = {"",
                                                         "rpm",
                                                         "Nm",
                                                         "\xb0"
                                                         "C",
                                                         "1/min",
                                                         "mm/s\xb2",
                                                         "\xb5m",
                                                         "%",
                                                         "k\xf6rn/\x80"};
            static constexpr std::string_view receivers[] = {"us", "us,them", "them", "others, us",
                                                             "Vector__XXX"};
            const std::string range = value_type.empty() && random_.one_in(4)
                                          ? "[-100|" + std::to_string(below(1000)) + ".5]"
                                          : "[0|0]";
            lines_.push_back(" SG_ " + name + (word.empty() ? " " : " " + word + " ") + ": " +
                             std::to_string(place(first)) + "|" + std::to_string(bits) +
                             (is_intel ? "@1" : "@0") + (is_signed ? "- " : "+ ") + scale + " " + range +
                             " \"" + any(units) + "\" " + any(receivers) + "\n");
            if (!value_type.empty())
                tail_ += "SIG_VALTYPE_ " + std::to_string(id_) + ' ' + name + " : " + value_type + ";\n";
            if (value_type.empty() && random_.one_in(4))
                tail_ += "VAL_ " + std::to_string(id_) + ' ' + name +
                         (is_signed ? " 0 \"zero\" -1 \"off\" ;\n" : " 0 \"aus \xe4\" 1 \"on, 2\" ;\n");
            return name;
        }
        return "";
    }

    Random random_;
    std::string text_, tail_;
    std::vector<std::string> lines_;
    std::size_t id_ = 0;
    std::size_t bytes_ = 0;
    bool is_fd_ = false;
    std::size_t signals_ = 0;
    Places used_{}, pages_{};
};

} // namespace tappet::can
