// Finds connected blobs of an image: pixels of weight above 0, joined with their eight neighbours. It labels
// the runs of a row and joins them with those of the row above: one pass, bounded, in fixed memory.
#pragma once

#include "apps/car_tracking/image.hpp"

#include <algorithm>
#include <span>

namespace tappet::car_tracking {

struct Blob {
    std::int64_t pixels = 0;
    std::int64_t weight = 0;
    std::int64_t weighted_column = 0; ///< sum of weight * column
    std::int64_t weighted_row = 0;
    std::size_t first_column = image_columns, last_column = 0, first_row = image_rows, last_row = 0;

    /// Returns the weighted centre in pixels. The blob must not be empty.
    [[nodiscard]] Eigen::Vector2d centre() const noexcept TAPPET_REALTIME {
        const auto total = static_cast<double>(weight);
        return {static_cast<double>(weighted_column) / total, static_cast<double>(weighted_row) / total};
    }
    /// Returns true when a part of the blob may lie outside the image.
    [[nodiscard]] bool touches_border() const noexcept TAPPET_REALTIME {
        return first_column == 0 || first_row == 0 || last_column + 1 == image_columns ||
               last_row + 1 == image_rows;
    }
    void add(const Blob& other) noexcept TAPPET_REALTIME {
        pixels += other.pixels;
        weight += other.weight;
        weighted_column += other.weighted_column;
        weighted_row += other.weighted_row;
        first_column = std::min(first_column, other.first_column);
        last_column = std::max(last_column, other.last_column);
        first_row = std::min(first_row, other.first_row);
        last_row = std::max(last_row, other.last_row);
    }
};

/// Finds the blobs of one image. The object is its own work space: 40 kB.
class BlobFinder {
public:
    static constexpr std::size_t most_blobs = 512; ///< labels; an image with more yields the first ones only

    /// Returns the blobs, in no order. `weigh(Colour)` returns an integer: 0 for a pixel of no blob, at most
    /// 1000. Real-time.
    template <class Weigh>
    std::span<const Blob> find(const Picture& image, Weigh weigh) noexcept TAPPET_REALTIME {
        count_ = 0;
        above_.fill(no_label);
        for (std::size_t row = 0; row < image_rows; ++row) {
            std::array<Label, image_columns> here;
            here.fill(no_label);
            for (std::size_t column = 0; column < image_columns; ++column) {
                const std::int64_t weight = weigh(image.at(row, column));
                if (weight <= 0) continue;
                const Label label = label_for(here, column);
                if (label == no_label) continue;
                here[column] = label;
                const auto x = static_cast<std::int64_t>(column);
                const auto y = static_cast<std::int64_t>(row);
                blobs_[label].add({1, weight, weight * x, weight * y, column, column, row, row});
            }
            above_ = here;
        }
        return gather();
    }

private:
    using Label = std::uint16_t;
    static constexpr Label no_label = 0xffff;

    [[nodiscard]] Label root_of(Label label) const noexcept TAPPET_REALTIME {
        while (parent_[label] != label) label = parent_[label]; // a parent is smaller than its child
        return label;
    }
    Label join(Label a, Label b) noexcept TAPPET_REALTIME {
        if (a == no_label) return b;
        if (b == no_label) return a;
        const Label one = root_of(a);
        const Label other = root_of(b);
        const Label low = std::min(one, other);
        parent_[std::max(one, other)] = low;
        return low;
    }
    /// Returns a pixel's label: the joined label of its neighbours, or a new one.
    Label label_for(const std::array<Label, image_columns>& here, std::size_t column) noexcept
        TAPPET_REALTIME {
        Label label = column > 0 ? here[column - 1] : no_label;
        const std::size_t from = column > 0 ? column - 1 : 0;
        const std::size_t to = std::min(column + 1, image_columns - 1);
        for (std::size_t i = from; i <= to; ++i) label = join(label, above_[i]);
        if (label != no_label) return label;
        if (count_ == most_blobs) return no_label;
        label = static_cast<Label>(count_++);
        parent_[label] = label;
        blobs_[label] = {};
        return label;
    }
    /// Adds up the joined blobs and moves the remaining ones to the front.
    std::span<const Blob> gather() noexcept TAPPET_REALTIME {
        std::size_t kept = 0;
        for (std::size_t i = count_; i-- > 0;)
            if (parent_[i] != i) blobs_[parent_[i]].add(blobs_[i]);
        for (std::size_t i = 0; i < count_; ++i)
            if (parent_[i] == i) blobs_[kept++] = blobs_[i];
        return std::span<const Blob>{blobs_}.first(kept);
    }

    std::size_t count_ = 0;
    std::array<Label, image_columns> above_{};
    std::array<Label, most_blobs> parent_{};
    std::array<Blob, most_blobs> blobs_{};
};

} // namespace tappet::car_tracking
