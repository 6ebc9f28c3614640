// Reads CPF: pugixml parses the XML, and the component's interface gives it its meaning. Nothing in the file
// is ignored.
#include "kernel/services/configuration/cpf.hpp"

#include "kernel/base/nearest.hpp"
#include "kernel/base/value_text.hpp"
#include "kernel/services/configuration/cpf_types.hpp"
#include "kernel/services/configuration/xml_text.hpp"

#include <pugixml.hpp>

#include <algorithm>
#include <array>

namespace tappet {

namespace {

std::string_view view(const char* text) noexcept { return text; }

/// The text of an element, joined where a comment or a CDATA section divides it.
class ElementText {
public:
    /// Reads the element. False when it contains an element, or is longer than any property's value.
    bool take(const pugi::xml_node& node) noexcept {
        length_ = 0;
        for (const pugi::xml_node& piece : node.children()) {
            if (piece.type() != pugi::node_pcdata && piece.type() != pugi::node_cdata) return false;
            const std::string_view characters = view(piece.value());
            if (characters.size() > characters_.size() - length_) return false;
            std::copy(characters.begin(), characters.end(), characters_.begin() + length_);
            length_ += characters.size();
        }
        return true;
    }
    [[nodiscard]] std::string_view whole() const noexcept { return {characters_.data(), length_}; }
    [[nodiscard]] std::string_view trimmed() const noexcept {
        std::string_view text = whole();
        while (!text.empty() && cpf::is_blank(text.front())) text.remove_prefix(1);
        while (!text.empty() && cpf::is_blank(text.back())) text.remove_suffix(1);
        return text;
    }

private:
    std::array<char, PropertyTransaction::max_bytes> characters_{};
    std::size_t length_ = 0;
};

/// The path "gains.roll.p" while the reader is inside those structs.
struct Path {
    static constexpr std::size_t capacity = 256;
    std::array<char, capacity> characters{};
    std::size_t length = 0;
    bool add(std::string_view name) noexcept {
        const bool dotted = length != 0;
        if (name.size() + (dotted ? 1 : 0) > capacity - length) return false;
        if (dotted) characters[length++] = '.';
        std::copy(name.begin(), name.end(), characters.begin() + static_cast<std::ptrdiff_t>(length));
        length += name.size();
        return true;
    }
    [[nodiscard]] std::string_view view() const noexcept { return {characters.data(), length}; }
};

class Reader {
public:
    Reader(std::string_view text, std::string_view file, PropertyTransaction& into, LeftOut left_out) noexcept
        : text_{text}, file_{file}, into_{into}, facets_{into.type().facets}, left_out_{left_out} {}

    Sentence read() noexcept {
        if (const auto zero = text_.find('\0'); zero != text_.npos)
            return at(line_at(zero), "holds a zero byte; it is not text; write the file again");
        if (const cpf::XmlFault fault = cpf::find_foreign_entity(text_); fault.what != nullptr)
            return at(line_at(fault.at), fault.what);
        pugi::xml_document document;
        const auto parsed = document.load_buffer(
            text_.data(), text_.size(),
            pugi::parse_default | pugi::parse_ws_pcdata_single | pugi::parse_fragment, pugi::encoding_utf8);
        if (!parsed)
            return at(line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0))),
                      Sentence{"is malformed XML: ", view(parsed.description()), "; correct it"}.view());
        pugi::xml_node properties;
        for (const pugi::xml_node& node : document.children()) {
            if (is_blank(node)) continue;
            if (node.type() != pugi::node_element || view(node.name()) != "properties" || properties)
                return at(node,
                          "is outside of <properties>; the file is one <properties> element, keep that");
            properties = node;
        }
        if (!properties) return at(1, "has no <properties> element; begin it with <properties>");
        if (properties.first_attribute())
            return at(properties, "has an attribute in <properties>; it has none, remove it");
        return read_members(properties, Path{});
    }

private:
    Sentence read_members(const pugi::xml_node& parent, const Path& path) noexcept {
        bool described = false;
        for (const pugi::xml_node& node : parent.children()) {
            if (is_blank(node)) continue;
            if (node.type() != pugi::node_element)
                return at(node, "has text where a property belongs; put it into the <value> of a <simple>");
            const std::string_view tag = view(node.name());
            if (tag == "description" && !described) {
                if (!description_.take(node))
                    return at(node, "has a <description> that is not plain text; shorten it");
                described = true;
                continue;
            }
            if (Sentence fault = read_property(node, path); !fault.empty()) {
                if (left_out_ == nullptr) return fault;
                left_out_(fault);
            }
        }
        return {};
    }

    Sentence read_property(const pugi::xml_node& node, Path path) noexcept {
        const std::string_view tag = view(node.name());
        if (tag != "simple" && tag != "struct" && tag != "sequence")
            return at(node,
                      Sentence{"has <", tag, ">, which is not a <simple>, <struct> or <sequence>; remove it"}
                          .view());
        if (Sentence fault = check_attributes(node, true); !fault.empty()) return fault;
        const std::string_view name = view(node.attribute("name").value());
        if (name.find('.') != name.npos)
            return at(
                node,
                Sentence{"names \"", name, "\" with a dot; put it into a <struct> for each bag"}.view());
        if (!path.add(name)) return at(node, "has a name that is too long for any property; correct it");
        const std::size_t index = find(path.view());
        const FacetKind wanted = tag == "struct" ? FacetKind::bag : FacetKind::property;
        if (index == facets_.size()) return unknown(node, path.view(), wanted);
        const Facet& facet = facets_[index];
        if (facet.kind == FacetKind::bag && tag == "struct") {
            if (Sentence fault = note(node, index); !fault.empty()) return fault;
            return read_members(node, path);
        }
        const bool is_list = facet.kind == FacetKind::property && facet.property->is_list;
        if (facet.kind != FacetKind::property || tag == "struct" || is_list != (tag == "sequence"))
            return at(node, Sentence{"has <", tag, "> for \"", path.view(), "\", which is ",
                                     is_list                             ? "a list; write a <sequence>"
                                     : facet.kind == FacetKind::bag      ? "a bag; write a <struct>"
                                     : facet.kind == FacetKind::property ? "one value; write a <simple>"
                                                                         : "no property; remove it"}
                                .view());
        if (Sentence fault = note(node, index); !fault.empty()) return fault;
        return read_value(node, index, is_list);
    }

    /// Reads a value. A wrong value leaves the earlier proposal.
    Sentence read_value(const pugi::xml_node& node, std::size_t index, bool is_list) noexcept {
        const Facet& facet = facets_[index];
        const bool was_changed = into_.changes(index);
        std::byte* place = into_.change(index);
        if (place == nullptr)
            return at(node, "has more properties than a transaction holds; divide the component");
        const std::size_t bytes = PropertyTransaction::bytes_for(facet);
        std::copy_n(place, bytes, before_.begin());
        Sentence fault =
            is_list ? read_list(node, facet, place) : read_simple(node, facet, *facet.type, place);
        if (fault.empty())
            if (const Sentence range = check_range(facet, place); !range.empty())
                fault = at(node, Sentence{"gives ", range}.view());
        if (fault.empty()) return {};
        if (was_changed)
            std::copy_n(before_.begin(), bytes, place);
        else
            into_.withdraw_last();
        return fault;
    }

    Sentence read_list(const pugi::xml_node& node, const Facet& facet, std::byte* place) noexcept {
        std::size_t size = 0;
        for (const pugi::xml_node& each : node.children()) size += view(each.name()) == "simple" ? 1u : 0u;
        if (!facet.property->resize(place, size))
            return at(node,
                      Sentence{"gives \"", facet.name, "\" ", size, " elements, but it has ",
                               facet.property->least_size == facet.property->most_size ? "" : "at most ",
                               facet.property->most_size, "; write so many <simple> elements"}
                          .view());
        std::size_t i = 0;
        bool described = false;
        for (const pugi::xml_node& each : node.children()) {
            if (is_blank(each)) continue;
            if (view(each.name()) == "description" && !described && description_.take(each)) {
                described = true;
                continue;
            }
            if (view(each.name()) != "simple")
                return at(each, Sentence{"has something in sequence \"", facet.name,
                                         "\" that is not a <simple>; remove it"}
                                    .view());
            if (Sentence fault = check_attributes(each, false); !fault.empty()) return fault;
            if (Sentence fault =
                    read_simple(each, facet, *facet.property->element, facet.property->at(place, i++));
                !fault.empty())
                return fault;
        }
        return {};
    }

    Sentence read_simple(const pugi::xml_node& node, const Facet& facet, const TypeTag& type,
                         std::byte* place) noexcept {
        const std::string_view type_name = view(node.attribute("type").value());
        if (!cpf::reads_as(type, type_name))
            return at(node, Sentence{"gives property \"", facet.name, "\" as ", type_name, ", but it is a ",
                                     cpf::type_name(type), "; write type=\"", cpf::type_name(type), "\""}
                                .view());
        pugi::xml_node value;
        bool described = false;
        for (const pugi::xml_node& each : node.children()) {
            if (is_blank(each)) continue;
            const std::string_view tag = view(each.name());
            if (tag == "description" && !described && description_.take(each))
                described = true;
            else if (tag == "value" && !value && !each.first_attribute())
                value = each;
            else
                return at(each, Sentence{"has more in <simple> \"", facet.name,
                                         "\" than one <description> and one <value>; remove it"}
                                    .view());
        }
        if (!value) return at(node, Sentence{"gives \"", facet.name, "\" no <value>; add one"}.view());
        if (!text_of_value_.take(value))
            return at(
                value,
                Sentence{"gives \"", facet.name, "\" a value that is not plain text; correct it"}.view());
        if (type.kind == ValueKind::text) {
            if (put_text(type, text_of_value_.whole(), place)) return {};
            return at(value, Sentence{"gives \"", facet.name, "\" more than its ", type.columns,
                                      " characters; shorten it"}
                                 .view());
        }
        std::string_view text = text_of_value_.trimmed();
        if (type.kind == ValueKind::boolean) text = text == "1" ? "true" : text == "0" ? "false" : text;
        if (const Sentence fault = parse_value(type, text, place); !fault.empty())
            return at(value, Sentence{"property \"", facet.name, "\": ", fault}.view());
        return {};
    }

    Sentence check_attributes(const pugi::xml_node& node, bool named) noexcept {
        bool has_name = false;
        bool has_type = false;
        for (const pugi::xml_attribute& each : node.attributes()) {
            bool* seen = view(each.name()) == "name"   ? &has_name
                         : view(each.name()) == "type" ? &has_type
                                                       : nullptr;
            if (seen == nullptr || *seen)
                return at(node, Sentence{"has attribute \"", view(each.name()),
                                         "\" where one name and one type belong; remove it"}
                                    .view());
            *seen = true;
        }
        if (named && !has_name)
            return at(node,
                      Sentence{"has <", view(node.name()), "> without a name; add name=\"...\""}.view());
        return {};
    }

    /// Notes a property or a bag; a second one of the same name is a fault.
    Sentence note(const pugi::xml_node& node, std::size_t index) noexcept {
        for (const Seen& each : seen_)
            if (each.facet == index)
                return at(node, Sentence{"gives \"", facets_[index].name, "\" again, as line ", each.line,
                                         " did; keep one"}
                                    .view());
        // There are no more different ones than the component has, which the check of its table bounds.
        if (!seen_.push({index, line_at(offset_of(node))}))
            return at(node, "has more properties than a transaction holds; divide the component");
        return {};
    }

    Sentence unknown(const pugi::xml_node& node, std::string_view name, FacetKind kind) const noexcept {
        Nearest nearest{name};
        for (const Facet& each : facets_)
            if (each.kind == kind) nearest.consider(each.name);
        Sentence text{"names ", kind == FacetKind::bag ? "bag" : "property", " \"", name,
                      "\", which the component does not have"};
        if (nearest.best().empty())
            text.add("; remove it");
        else
            text.add("; did you mean \"").add(nearest.best()).add("\"?");
        return at(node, text.view());
    }

    static bool put_text(const TypeTag& type, std::string_view text, std::byte* place) noexcept {
        if (text.size() > type.columns) return false;
        std::memset(place, 0, type.size);
        std::memcpy(place, text.data(), text.size());
        const auto length = static_cast<std::uint32_t>(text.size());
        static_assert(sizeof length == sizeof(Text<1>::length));
        std::memcpy(place + type.length_at, &length, sizeof length);
        return true;
    }

    [[nodiscard]] std::size_t find(std::string_view name) const noexcept {
        std::size_t f = 0;
        while (f < facets_.size() && (facets_[f].name != name || (facets_[f].kind != FacetKind::property &&
                                                                  facets_[f].kind != FacetKind::bag)))
            ++f;
        return f;
    }
    static bool is_blank(const pugi::xml_node& node) noexcept {
        if (node.type() != pugi::node_pcdata) return false;
        const std::string_view text = view(node.value());
        return std::all_of(text.begin(), text.end(), cpf::is_blank);
    }
    static std::size_t offset_of(const pugi::xml_node& node) noexcept {
        return static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    }
    [[nodiscard]] std::size_t line_at(std::size_t offset) const noexcept {
        const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text_.size()));
        return 1 + static_cast<std::size_t>(std::count(text_.begin(), end, '\n'));
    }
    [[nodiscard]] Sentence at(const pugi::xml_node& node, std::string_view fault) const noexcept {
        std::size_t offset = offset_of(node);
        while (offset < text_.size() && cpf::is_blank(text_[offset]))
            ++offset; // a text begins with its blanks
        return at(line_at(offset), fault);
    }
    [[nodiscard]] Sentence at(std::size_t line, std::string_view fault) const noexcept {
        return Sentence{file_, ":", line, ": component \"", into_.name(), "\": the file ", fault};
    }

    struct Seen {
        std::size_t facet = 0;
        std::size_t line = 0;
    };

    std::string_view text_;
    std::string_view file_;
    PropertyTransaction& into_;
    std::span<const Facet> facets_;
    Bounded<Seen, 2 * PropertyTransaction::max_values> seen_{};
    ElementText text_of_value_{};
    ElementText description_{};
    LeftOut left_out_;
    std::array<std::byte, PropertyTransaction::max_bytes> before_{};
};

} // namespace

Sentence read_cpf(std::string_view text, std::string_view file, PropertyTransaction& into,
                  LeftOut left_out) noexcept {
    if (text.size() > max_cpf_bytes)
        return Sentence{file,          ": component \"",
                        into.name(),   "\": the file has more than ",
                        max_cpf_bytes, " bytes; check that it is a properties file, or shorten it"};
    return Reader{text, file, into, left_out}.read();
}

} // namespace tappet
