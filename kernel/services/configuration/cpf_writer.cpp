// Writes CPF into existing memory: after arming there is no heap for a document.
#include "kernel/services/configuration/cpf.hpp"

#include "kernel/base/value_text.hpp"
#include "kernel/services/configuration/cpf_types.hpp"

#include <algorithm>
#include <array>

namespace tappet {

namespace {

class Writer {
public:
    Writer(const PropertyTransaction& from, std::span<char> into, std::span<const CpfListForm> forms) noexcept
        : from_{from}, into_{into}, forms_{forms} {}

    std::size_t write(Sentence& fault) noexcept {
        put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE properties SYSTEM "
            "\"cpf.dtd\">\n<properties>\n");
        const auto facets = from_.type().facets;
        write_members(0, facets.size(), 1);
        put("</properties>\n");
        if (fault_.empty() && overflow_)
            fault_ = Sentence{"component \"", from_.name(), "\": its properties take more than ",
                              into_.size(), " bytes of file; shorten their descriptions"};
        fault = fault_;
        return fault_.empty() ? length_ : 0;
    }

private:
    // A bag in a bag is a nested call: the depth of the component's interface, which its names bound.
    void write_members(std::size_t begin, std::size_t end, std::size_t depth) noexcept {
        const auto facets = from_.type().facets;
        for (std::size_t f = begin; f < end; ++f) {
            const Facet& facet = facets[f];
            if (facet.kind == FacetKind::property) {
                write_property(f, depth);
            } else if (facet.kind == FacetKind::bag) {
                indent(depth);
                put("<struct name=\"");
                escape(own_name(facet));
                put("\" type=\"PropertyBag\">\n");
                indent(depth + 1);
                describe(facet);
                put("\n");
                write_members(f + 1, f + 1 + facet.members, depth + 1);
                indent(depth);
                put("</struct>\n");
                f += facet.members;
            }
        }
    }

    void write_property(std::size_t f, std::size_t depth) noexcept {
        const Facet& facet = from_.type().facets[f];
        const auto values = from_.values();
        const auto found = std::ranges::find(values, f, &ProposedValue::facet);
        if (found == values.end()) return;
        if (facet.property->is_list) return write_list(f, *found, depth);
        indent(depth);
        put("<simple name=\"");
        escape(own_name(facet));
        put("\" type=\"");
        put(cpf::type_name(*facet.property->element));
        put("\">");
        describe(facet);
        write_value(facet, *facet.type, found->value);
        put("</simple>\n");
    }

    void write_list(std::size_t f, const ProposedValue& found, std::size_t depth) noexcept {
        const Facet& facet = from_.type().facets[f];
        const TypeTag& type = *facet.type;
        const auto known = std::ranges::find_if(forms_, [&](const CpfListForm& each) {
            return each.component == from_.name() && each.facet == f;
        });
        const CpfListForm form = known == forms_.end() ? CpfListForm{} : *known;
        const auto element = [&](const CpfListForm::Layer& layer, std::size_t number, std::size_t index,
                                 std::size_t at_depth) {
            indent(at_depth);
            put("<simple ");
            number_name(layer, number);
            put("type=\"");
            put(cpf::type_name(*facet.property->element));
            put("\">");
            // The element is only read.
            write_value(facet, *facet.property->element,
                        facet.property->at(const_cast<std::byte*>(found.value), index));
            put("</simple>\n");
        };
        const std::size_t count = form.in_rows ? type.rows : facet.property->size(found.value);
        indent(depth);
        put(form.list.is_struct ? "<struct name=\"" : "<sequence name=\"");
        escape(own_name(facet));
        put("\" ");
        open(form.list, facet);
        describe(facet);
        put("\n");
        write_size(form.list, count, depth + 1);
        for (std::size_t i = 0; i < count; ++i) {
            if (!form.in_rows) {
                element(form.list, i, i, depth + 1);
                continue;
            }
            indent(depth + 1);
            put(form.row.is_struct ? "<struct " : "<sequence ");
            number_name(form.list, i);
            open(form.row, facet);
            put("\n");
            write_size(form.row, type.columns, depth + 2);
            for (std::size_t c = 0; c < type.columns; ++c)
                element(form.row, c, type.row_major ? i * type.columns + c : c * type.rows + i, depth + 2);
            close(form.row, depth + 1);
        }
        close(form.list, depth);
    }
    void open(const CpfListForm::Layer& layer, const Facet& facet) noexcept {
        put("type=\"");
        escape(layer.type.length != 0 ? layer.type.view() : cpf::type_name(*facet.property->element));
        put("\">");
    }
    void close(const CpfListForm::Layer& layer, std::size_t depth) noexcept {
        indent(depth);
        put(layer.is_struct ? "</struct>\n" : "</sequence>\n");
    }
    void number_name(const CpfListForm::Layer& layer, std::size_t i) noexcept {
        if (!layer.has_names) return;
        put("name=\"");
        escape(layer.stem.view());
        put(Sentence{layer.first + i, "\" "}.view());
    }
    void write_size(const CpfListForm::Layer& layer, std::size_t size, std::size_t depth) noexcept {
        if (!layer.has_size) return;
        indent(depth);
        put(Sentence{"<simple name=\"Size\" type=\"long\"><value>", size, "</value></simple>\n"}.view());
    }

    void write_value(const Facet& facet, const TypeTag& type, const std::byte* value) noexcept {
        put("<value>");
        if (type.kind == ValueKind::text) {
            std::uint32_t length = 0;
            std::memcpy(&length, value + type.length_at, sizeof length);
            const std::string_view text{reinterpret_cast<const char*>(value),
                                        std::min<std::size_t>(length, type.columns)};
            if (text.find('\0') != text.npos && fault_.empty())
                fault_ = Sentence{"component \"", from_.name(), "\": property \"", facet.name,
                                  "\" holds a zero character, which no file keeps; set another text"};
            escape(text);
        } else {
            std::array<char, 64> text{};
            const std::size_t length = format_value(type, value, text);
            if (length == 0 && fault_.empty())
                fault_ = Sentence{"component \"", from_.name(), "\": property \"", facet.name,
                                  "\" has no text; give its enumeration a name for every value"};
            escape({text.data(), length});
        }
        put("</value>");
    }

    void describe(const Facet& facet) noexcept {
        put("<description>");
        escape(facet.doc);
        if (!facet.unit.empty()) {
            put(" [");
            escape(facet.unit);
            put("]");
        }
        put("</description>");
    }

    static std::string_view own_name(const Facet& facet) noexcept {
        return facet.name.substr(facet.name.rfind('.') + 1);
    }
    void indent(std::size_t depth) noexcept {
        for (std::size_t i = 0; i < depth; ++i) put("  ");
    }
    void escape(std::string_view text) noexcept {
        for (const char character : text) {
            switch (character) {
            case '&': put("&amp;"); break;
            case '<': put("&lt;"); break;
            case '>': put("&gt;"); break;
            case '"': put("&quot;"); break;
            default:
                if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f)
                    put(Sentence{"&#", static_cast<int>(character), ";"}.view());
                else
                    put({&character, 1});
            }
        }
    }
    void put(std::string_view text) noexcept {
        if (text.size() > into_.size() - length_) {
            overflow_ = true;
            return;
        }
        std::copy(text.begin(), text.end(), into_.begin() + static_cast<std::ptrdiff_t>(length_));
        length_ += text.size();
    }

    const PropertyTransaction& from_;
    std::span<char> into_;
    std::span<const CpfListForm> forms_;
    std::size_t length_ = 0;
    bool overflow_ = false;
    Sentence fault_{};
};

} // namespace

std::size_t write_cpf(const PropertyTransaction& from, std::span<char> into, Sentence& fault,
                      std::span<const CpfListForm> forms) noexcept {
    return Writer{from, into, forms}.write(fault);
}

} // namespace tappet
