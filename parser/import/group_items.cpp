// Solids are listed more than once: by drawings, by aspects of a shape, by approximations. Each is taken where it is
// the shape of something.

#include "parser/import/group_items.h"

#include <algorithm>
#include <unordered_set>

#include "parser/import/solids.h"

namespace lyr::importer {

namespace {

bool is_exact(const File& file, InstanceIndex item) {
    const ItemKind kind = kind_of(file, item);
    return kind == ItemKind::solid || kind == ItemKind::surface_model;
}

class Grouping {
public:
    Grouping(const File& file, const RepresentationTable& table, Diagnostics& diagnostics)
        : file_(file),
          table_(table),
          diagnostics_(diagnostics),
          groups_(table.representations.size()) {}

    std::vector<GroupItems> take() {
        find_products();
        find_listings();
        for (std::size_t i = 0; i < table_.representations.size(); ++i) add(RepresentationId(i));
        leave_out_approximations();
        return std::move(groups_);
    }

private:
    std::uint32_t group_of(std::size_t i) const { return table_.united(RepresentationId(i)).value; }

    static std::uint64_t key(std::uint32_t group, InstanceIndex item) {
        return std::uint64_t{group} << 32 | item.value;
    }

    void find_products() {
        for (std::size_t i = 0; i < table_.representations.size(); ++i) {
            GroupItems& g = groups_[group_of(i)];
            if (!g.product.valid()) g.product = table_.representations[i].product;
        }
    }

    void find_listings() {
        for (std::size_t i = 0; i < table_.representations.size(); ++i) {
            const Representation& r = table_.representations[i];
            const std::uint32_t group = group_of(i);
            for (const InstanceIndex item : r.items) {
                if (groups_[group].product.valid()) of_products_.insert(item.value);
                if (r.is_shape) of_shapes_.insert(item.value);
                if (r.is_of_aspect || !is_exact(file_, item)) continue;
                own_.insert(key(group, item));
                with_body_.insert(group);
            }
        }
    }

    void add(RepresentationId id) {
        const Representation& r = table_[id];
        const std::uint32_t group = table_.united(id).value;
        GroupItems& g = groups_[group];
        for (const InstanceIndex item : r.items) {
            if (kind_of(file_, item) == ItemKind::mapped) continue;
            const bool elsewhere = (!g.product.valid() && of_products_.contains(item.value)) ||
                                   (!r.is_shape && of_shapes_.contains(item.value));
            if (elsewhere || !known_.insert(key(group, item)).second) continue;
            const bool is_feature = r.is_of_aspect && with_body_.contains(group);
            if (is_feature && !own_.contains(key(group, item))) {
                Diagnostic note = file_.error(
                    item, named(file_, item) + " is the shape of a feature, not a part");
                note.severity = Severity::note;
                diagnostics_.push_back(std::move(note));
                continue;
            }
            g.items.emplace_back(item, id);
        }
    }

    void leave_out_approximations() {
        const auto has_exact = [&](const GroupItems& g) {
            return std::any_of(g.items.begin(), g.items.end(),
                               [&](const auto& item) { return is_exact(file_, item.first); });
        };
        const bool any_exact = std::any_of(groups_.begin(), groups_.end(), has_exact);
        for (GroupItems& g : groups_) {
            if (!has_exact(g) && (g.product.valid() || !any_exact)) continue;
            std::erase_if(g.items, [&](const auto& item) {
                if (kind_of(file_, item.first) != ItemKind::tessellated) return false;
                diagnostics_.push_back(
                    warning(file_, item.first,
                            named(file_, item.first) +
                                " is made of triangles; the exact shape beside it is taken",
                            ExitStatus::unsupported));
                return true;
            });
        }
    }

    const File& file_;
    const RepresentationTable& table_;
    Diagnostics& diagnostics_;
    std::vector<GroupItems> groups_;
    std::unordered_set<std::uint32_t> of_products_,
        of_shapes_;                                // items that a product, a shape lists
    std::unordered_set<std::uint64_t> own_;        // by group, items that are not of an aspect only
    std::unordered_set<std::uint32_t> with_body_;  // groups that have such an item
    std::unordered_set<std::uint64_t> known_;      // items by group
};

}  // namespace

std::vector<GroupItems> group_items(const File& file, const RepresentationTable& table,
                                    Diagnostics& diagnostics) {
    return Grouping(file, table, diagnostics).take();
}

}  // namespace lyr::importer
