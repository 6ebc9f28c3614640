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
#include <charconv>

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
    Reader(std::string_view text, std::string_view file, PropertyTransaction& into, LeftOut left_out,
           CpfListForms* forms) noexcept
        : text_{text},
          file_{file},
          into_{into},
          facets_{into.type().facets},
          left_out_{left_out},
          forms_{forms} {}

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
        if (index == facets_.size()) return unknown(node, path.view(), tag == "struct");
        const Facet& facet = facets_[index];
        if (facet.kind == FacetKind::bag && tag == "struct") {
            if (Sentence fault = note(node, index); !fault.empty()) return fault;
            return read_members(node, path);
        }
        const bool is_list = facet.kind == FacetKind::property && facet.property->is_list;
        if (facet.kind != FacetKind::property || is_list != (tag != "simple"))
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
        CpfListForm form{.component = into_.name(), .facet = index};
        Sentence fault =
            is_list ? read_list(node, facet, place, form) : read_simple(node, facet, *facet.type, place);
        if (fault.empty())
            if (const Sentence range = check_range(facet, place); !range.empty())
                fault = at(node, Sentence{"gives ", range}.view());
        if (fault.empty() && is_list && !keep(form))
            fault = at(node, Sentence{"gives \"", facet.name, "\" in a form of its own, as ",
                                      CpfListForms::capacity(),
                                      " other lists of the machine are; write a <sequence> of the type ",
                                      cpf::type_name(*facet.property->element), " without Size and names"}
                                 .view());
        if (fault.empty()) return {};
        if (was_changed)
            std::copy_n(before_.begin(), bytes, place);
        else
            into_.withdraw_last();
        return fault;
    }

    /// Keeps the form of a list for the next saving. False: there is no room.
    bool keep(const CpfListForm& form) noexcept {
        if (forms_ == nullptr) return true;
        for (CpfListForm& each : *forms_)
            if (each.component == form.component && each.facet == form.facet) {
                each = form;
                return true;
            }
        CpfListForm::Layer plain;
        static_cast<void>(plain.type.assign(cpf::type_name(*facets_[form.facet].property->element)));
        return (form.list == plain && !form.in_rows) || forms_->push(form);
    }

    Sentence read_list(const pugi::xml_node& node, const Facet& facet, std::byte* place,
                       CpfListForm& form) noexcept {
        const TypeTag& type = *facet.type;
        const PropertyOperations& list = *facet.property;
        const auto is_list = [](const pugi::xml_node& each) { return view(each.name()) != "simple"; };
        const auto elements = node.children();
        form.in_rows = type.kind == ValueKind::matrix && type.columns > 1 &&
                       std::ranges::any_of(elements, [&](const pugi::xml_node& each) {
                           return is_element(each) && is_list(each);
                       });
        const std::size_t count = count_elements(node);
        const std::size_t least = form.in_rows ? type.rows : list.least_size;
        const std::size_t most = form.in_rows ? type.rows : list.most_size;
        if (Sentence fault = read_size(node, facet, count, form.list); !fault.empty()) return fault;
        if (count < least || count > most || (!form.in_rows && !list.resize(place, count)))
            return at(node, Sentence{"gives \"", facet.name, "\" ", count,
                                     form.in_rows ? " rows, but it has " : " elements, but it has ",
                                     least == most ? "" : "at most ", most, "; write so many ",
                                     form.in_rows ? "of them" : "<simple> elements"}
                                .view());
        return read_layer(node, facet, form.list, [&](const pugi::xml_node& each, std::size_t r) {
            if (!form.in_rows) return read_element(each, facet, list.at(place, r));
            const std::size_t cells = is_list(each) ? count_elements(each) : 0;
            if (cells != type.columns)
                return at(each, Sentence{"gives row ", r, " of \"", facet.name, "\" ", cells,
                                         " elements, but it has ", type.columns, "; write so many"}
                                    .view());
            form.row = {};
            if (Sentence fault = read_size(each, facet, cells, form.row); !fault.empty()) return fault;
            return read_layer(each, facet, form.row, [&](const pugi::xml_node& cell, std::size_t c) {
                return read_element(
                    cell, facet, list.at(place, type.row_major ? r * type.columns + c : c * type.rows + r));
            });
        });
    }

    static bool is_size(const pugi::xml_node& node) noexcept {
        return view(node.name()) == "simple" && view(node.attribute("name").value()) == "Size";
    }
    static bool is_element(const pugi::xml_node& node) noexcept {
        return node.type() == pugi::node_element && view(node.name()) != "description" && !is_size(node);
    }
    static std::size_t count_elements(const pugi::xml_node& list) noexcept {
        return static_cast<std::size_t>(std::ranges::count_if(list.children(), is_element));
    }

    /// Compares the size that the list itself states, as Orocos writes it, with its elements.
    Sentence read_size(const pugi::xml_node& list, const Facet& facet, std::size_t count,
                       CpfListForm::Layer& layer) noexcept {
        static constexpr Facet size_of_list{.name = "Size"};
        for (const pugi::xml_node& each : list.children()) {
            if (!is_size(each)) continue;
            if (layer.has_size)
                return at(each, Sentence{"gives \"", facet.name, "\" a second Size; keep one"}.view());
            layer.has_size = true;
            std::uint64_t size = 0;
            if (Sentence fault = check_attributes(each, true); !fault.empty()) return fault;
            if (Sentence fault = read_simple(each, size_of_list, *type_id<std::uint64_t>,
                                             reinterpret_cast<std::byte*>(&size));
                !fault.empty())
                return fault;
            if (size != count)
                return at(each, Sentence{"gives \"", facet.name, "\" ", count, " elements, but its Size is ",
                                         size, "; correct the Size, or what is missing"}
                                    .view());
        }
        return {};
    }

    /// Reads the elements of a list or of a matrix' row, each by `read_one`, and notes their form.
    template <class ReadOne>
    Sentence read_layer(const pugi::xml_node& list, const Facet& facet, CpfListForm::Layer& layer,
                        ReadOne&& read_one) noexcept {
        layer.is_struct = view(list.name()) == "struct";
        if (!layer.type.assign(view(list.attribute("type").value())))
            return at(
                list,
                Sentence{"gives \"", facet.name, "\" a type of more than 95 characters; shorten it"}.view());
        std::size_t i = 0;
        bool described = false;
        for (const pugi::xml_node& each : list.children()) {
            if (is_blank(each) || is_size(each)) continue;
            if (view(each.name()) == "description" && !described && description_.take(each)) {
                described = true;
                continue;
            }
            if (Sentence fault = check_attributes(each, false); !fault.empty()) return fault;
            if (Sentence fault = read_one(each, i); !fault.empty()) return fault;
            if (!is_in_order(view(each.attribute("name").value()), i, layer))
                return at(each, Sentence{"names element ", i, " of \"", facet.name, "\" \"",
                                         view(each.attribute("name").value()),
                                         "\", but names count the elements in their order; write \"",
                                         layer.stem.view(), layer.first + i, "\", or no name"}
                                    .view());
            ++i;
        }
        layer.has_names |= i == 0 && layer.has_size;
        return {};
    }

    /// Whether the name is empty, or a word and a number that counts the elements. The first name decides the
    /// word, and whether 0 or 1 is first.
    static bool is_in_order(std::string_view name, std::size_t i, CpfListForm::Layer& layer) noexcept {
        if (name.empty()) return true;
        const std::string_view stem = name.substr(0, name.find_last_not_of("0123456789") + 1);
        const std::string_view digits = name.substr(stem.size());
        std::size_t number = 0;
        const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        if (read.ec != std::errc{}) return false;
        if (!layer.has_names) {
            if (!layer.stem.assign(stem)) return false;
            layer.has_names = true;
            layer.first = number == i + 1 ? 1 : 0;
        }
        return stem == layer.stem.view() && number == layer.first + i;
    }

    Sentence read_element(const pugi::xml_node& node, const Facet& facet, std::byte* place) noexcept {
        if (view(node.name()) != "simple")
            return at(node,
                      Sentence{"has something in list \"", facet.name, "\" that is not a <simple>; remove it"}
                          .view());
        return read_simple(node, facet, *facet.property->element, place);
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

    Sentence unknown(const pugi::xml_node& node, std::string_view name, bool is_struct) const noexcept {
        Nearest nearest{name};
        for (const Facet& each : facets_)
            if (each.kind == FacetKind::property ? !is_struct || each.property->is_list
                                                 : is_struct && each.kind == FacetKind::bag)
                nearest.consider(each.name);
        Sentence text{"names ", is_struct ? "bag or list" : "property", " \"", name,
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
    CpfListForms* forms_;
    std::array<std::byte, PropertyTransaction::max_bytes> before_{};
};

} // namespace

Sentence read_cpf(std::string_view text, std::string_view file, PropertyTransaction& into, LeftOut left_out,
                  CpfListForms* forms) noexcept {
    if (text.size() > max_cpf_bytes)
        return Sentence{file,          ": component \"",
                        into.name(),   "\": the file has more than ",
                        max_cpf_bytes, " bytes; check that it is a properties file, or shorten it"};
    return Reader{text, file, into, left_out, forms}.read();
}

} // namespace tappet
