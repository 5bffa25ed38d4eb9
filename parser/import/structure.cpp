// Placements: links between groups of representations, unfolded from the roots.

#include "parser/import/structure.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "kernel/geometry/tolerance.h"
#include "parser/import/group_items.h"
#include "parser/import/placement.h"
#include "parser/import/representations.h"
#include "parser/import/solids.h"

namespace lyr::importer {

namespace {

// Of a group's representation in another's.
struct Link {
    RepresentationId parent, child;
    RepresentationId target;  // whose units the placement in the parent has
    InstanceIndex stated_by;  // relationship, MAPPED_ITEM or usage without a placement
    const Relationship* relationship = nullptr;  // if that is what states it
    bool child_is_first = true;                  // of the relationship's two
    std::optional<Eigen::Affine3d> placement;    // once it has been needed
};

struct Group {
    std::vector<std::size_t> links;
    std::vector<std::pair<InstanceIndex, RepresentationId>> items;  // without mapped items
    InstanceIndex product;  // PRODUCT_DEFINITION; not valid(): none
    bool is_placed = false;
    std::optional<std::size_t> total;  // items here and below, as often as they are placed
};

class Structure {
public:
    Structure(const File& file, RepresentationTable table, UnitTable& units,
              Diagnostics& diagnostics)
        : file_(file),
          table_(std::move(table)),
          units_(units),
          diagnostics_(diagnostics),
          trail_(file) {}

    Result<std::vector<Placed>> unfold() {
        groups_.resize(table_.representations.size());
        if (const Status status = add_links(); !status) return status.error();
        add_items();
        std::size_t total = 0;
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            if (!is_group(i)) continue;
            const Result<std::size_t> below = count(RepresentationId(i));
            if (!below) return below.error();
            if (!groups_[i].is_placed) total += *below;
        }
        if (total > max_placements) {
            return Diagnostic{Severity::error,
                              ExitStatus::unsupported,
                              "the assembly structure places more than " +
                                  std::to_string(max_placements) + " solids",
                              {.file = file_.name()}};
        }
        if (const Status status = place_links(); !status) return status.error();
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            if (is_group(i) && !groups_[i].is_placed)
                emit(RepresentationId(i), Eigen::Affine3d::Identity());
        }
        add_loose_items();
        return std::move(placed_);
    }

private:
    bool is_group(std::size_t i) const { return table_.united(RepresentationId(i)).value == i; }
    Group& group(RepresentationId id) { return groups_[table_.united(id).value]; }

    void add_link(Link link) {
        group(link.parent).links.push_back(links_.size());
        group(link.child).is_placed = true;
        links_.push_back(std::move(link));
    }

    Status add_links() {
        for (const Usage& usage : table_.usages)
            usage_by_instance_.emplace(usage.instance.value, &usage);
        for (const Relationship& r : table_.relationships) {
            if (!r.transformation.valid() && !r.usage.valid()) continue;
            const bool occurrence =
                r.usage.valid() && file_.is(r.usage, "NEXT_ASSEMBLY_USAGE_OCCURRENCE");
            // Other usages (a specified higher one, a promissory one) do not place a solid once more.
            if (r.usage.valid() && !occurrence) continue;
            if (!r.first.valid() || !r.second.valid()) {
                if (!occurrence) continue;
                return file_.error(r.instance,
                                   named(file_, r.instance) + ": two representations expected");
            }
            const bool is_shape = table_[r.first].is_shape && table_[r.second].is_shape;
            if (!occurrence && !is_shape) continue;
            const bool child_is_first = occurrence ? child_is_first_of(r) : !whole_is_first_of(r);
            const RepresentationId parent = child_is_first ? r.second : r.first;
            const RepresentationId child = child_is_first ? r.first : r.second;
            add_link({parent, child, parent, r.instance, &r, child_is_first, {}});
        }
        for (const Representation& r : table_.representations) {
            if (!r.is_shape || r.usage.valid()) continue;
            for (const InstanceIndex item : r.items) listed_by_shapes_.insert(item.value);
        }
        for (std::size_t i = 0; i < table_.representations.size(); ++i) {
            if (!table_.representations[i].is_shape) continue;
            if (const Status status = add_mapped_items(RepresentationId(i)); !status) return status;
        }
        add_unplaced_usages();
        return Done{};
    }

    // Writers disagree on whether rep_1 or rep_2 is the component's; the product structure knows.
    bool child_is_first_of(const Relationship& r) {
        const auto usage = usage_by_instance_.find(r.usage.value);
        const RepresentationId first = table_.united(r.first), second = table_.united(r.second);
        if (usage == usage_by_instance_.end() || first == second) return true;
        const RepresentationId child = table_.of_product(usage->second->child),
                               parent = table_.of_product(usage->second->parent);
        if (child.valid() && table_.united(child) == first) return true;
        if (child.valid() && table_.united(child) == second) return false;
        return !(parent.valid() && table_.united(parent) == first);
    }

    // Without a product structure, a representation that is a product's is the whole, the other the component.
    bool whole_is_first_of(const Relationship& r) const {
        return table_[r.first].product.valid() && !table_[r.second].product.valid();
    }

    // A representation of a usage holds the mapped item that places the component. Where the assembly's own
    // representation lists it too, it is the same placement; else the usage says what the assembly is.
    RepresentationId whole_of_mapped(RepresentationId representation, InstanceIndex item) {
        const InstanceIndex usage = table_[representation].usage;
        if (!usage.valid()) return representation;
        if (listed_by_shapes_.contains(item.value)) return {};
        const auto found = usage_by_instance_.find(usage.value);
        if (found == usage_by_instance_.end()) return representation;
        const RepresentationId whole = table_.of_product(found->second->parent);
        return whole.valid() ? whole : representation;
    }

    Status add_mapped_items(RepresentationId parent) {
        for (const InstanceIndex item : table_[parent].items) {
            if (kind_of(file_, item) != ItemKind::mapped) continue;
            const RepresentationId whole = whole_of_mapped(parent, item);
            if (!whole.valid()) continue;
            const Result<InstanceIndex> source = mapped_attribute(item, 0);
            if (!source) return source.error();
            if (keyword(file_, *source) != "REPRESENTATION_MAP")
                continue;  // of a symbol or the like
            Fields fields(file_, *source, 2);
            const InstanceIndex mapped = fields.reference(1);
            if (!fields.ok()) return fields.error();
            const RepresentationId child = table_.find(mapped);
            if (child.valid()) add_link({whole, child, parent, item, nullptr, true, {}});
        }
        return Done{};
    }

    Result<InstanceIndex> mapped_attribute(InstanceIndex item, std::size_t number) {
        Attributes a(file_, item, "MAPPED_ITEM", 1, 2);
        const InstanceIndex value = a.fields.reference(a.first + number);
        if (!a.fields.ok()) return a.fields.error();
        return value;
    }

    // Occurrences for which the file gives neither relationship nor mapped item: the component stays where it is.
    void add_unplaced_usages() {
        std::unordered_set<std::uint32_t> placed;
        for (const Relationship& r : table_.relationships) {
            if (r.usage.valid()) placed.insert(r.usage.value);
        }
        std::unordered_set<std::uint64_t> linked;
        const auto key = [&](RepresentationId parent, RepresentationId child) {
            return std::uint64_t{table_.united(parent).value} << 32 | table_.united(child).value;
        };
        for (const Link& link : links_) linked.insert(key(link.parent, link.child));
        for (const Usage& usage : table_.usages) {
            const RepresentationId parent = table_.of_product(usage.parent);
            const RepresentationId child = table_.of_product(usage.child);
            if (placed.contains(usage.instance.value) || !parent.valid() || !child.valid())
                continue;
            if (table_.united(parent) == table_.united(child)) continue;
            if (linked.insert(key(parent, child)).second) {
                add_link({parent, child, parent, usage.instance, nullptr, true, {}});
            }
        }
    }

    void add_items() {
        std::vector<GroupItems> items = group_items(file_, table_, diagnostics_);
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            groups_[i].product = items[i].product;
            groups_[i].items = std::move(items[i].items);
        }
        for (const Representation& r : table_.representations) {
            for (const InstanceIndex item : r.items) listed_.insert(item.value);
        }
    }

    Result<std::size_t> count(RepresentationId id) {
        const RepresentationId first = table_.united(id);
        if (groups_[first.value].total) return *groups_[first.value].total;
        const auto step = trail_.enter(table_[first].instance);
        if (!step) return step.error();
        std::size_t total = groups_[first.value].items.size();
        for (const std::size_t link : groups_[first.value].links) {
            const Result<std::size_t> below = count(links_[link].child);
            if (!below) return below.error();
            // Saturates far below overflow and above what is accepted.
            total = std::min(total + *below, 2 * max_placements);
        }
        groups_[first.value].total = total;
        return total;
    }

    // Works out the placements of links that lead to solids, and drops those that state another one again.
    Status place_links() {
        for (Group& g : groups_) {
            std::vector<std::size_t> kept;
            std::multimap<std::pair<std::uint32_t, double>, const Link*> known;  // by child and x
            for (const std::size_t i : g.links) {
                Link& link = links_[i];
                if (*group(link.child).total == 0) continue;
                const Result<Eigen::Affine3d> placement = placement_of(link);
                if (!placement) return placement.error();
                link.placement = *placement;
                const std::uint32_t child = table_.united(link.child).value;
                const double x = placement->translation().x();
                const auto first = known.lower_bound({child, x - resolution_mm});
                const auto last = known.upper_bound({child, x + resolution_mm});
                const bool again = std::any_of(first, last, [&](const auto& entry) {
                    return same_place(*entry.second->placement, *placement);
                });
                if (again) continue;
                known.emplace(std::pair(child, x), &link);
                kept.push_back(i);
            }
            g.links = std::move(kept);
        }
        return Done{};
    }

    static bool same_place(const Eigen::Affine3d& a, const Eigen::Affine3d& b) {
        // A turn by the angular resolution moves what is a metre away by resolution_mm.
        return (a.linear() - b.linear()).cwiseAbs().maxCoeff() <= angular_resolution_rad &&
               (a.translation() - b.translation()).cwiseAbs().maxCoeff() <= resolution_mm;
    }

    Result<Eigen::Affine3d> placement_of(const Link& link) {
        if (kind_of(file_, link.stated_by) == ItemKind::mapped) return mapped_placement(link);
        if (link.relationship == nullptr) {
            diagnostics_.push_back(
                warning(file_, link.stated_by,
                        named(file_, link.stated_by) +
                            " has no placement; the component stays in its own coordinates"));
            return Eigen::Affine3d(Eigen::Affine3d::Identity());
        }
        if (!link.relationship->transformation.valid())
            return Eigen::Affine3d(Eigen::Affine3d::Identity());
        return related_placement(link, *link.relationship);
    }

    Result<Eigen::Affine3d> mapped_placement(const Link& link) {
        const Result<InstanceIndex> source = mapped_attribute(link.stated_by, 0);
        if (!source) return source.error();
        const Result<InstanceIndex> target = mapped_attribute(link.stated_by, 1);
        if (!target) return target.error();
        Fields fields(file_, *source, 2);
        const InstanceIndex origin = fields.reference(0);
        if (!fields.ok()) return fields.error();
        return between(link, origin, *source, *target, link.stated_by);
    }

    // From the child's item to the parent's, each in its own units.
    Result<Eigen::Affine3d> between(const Link& link, InstanceIndex of_child,
                                    InstanceIndex child_user, InstanceIndex of_parent,
                                    InstanceIndex parent_user) {
        const Result<Units> child_units = units_.of_context(table_[link.child].context);
        if (!child_units) return child_units.error();
        const Result<Units> parent_units = units_.of_context(table_[link.target].context);
        if (!parent_units) return parent_units.error();
        const Result<Eigen::Affine3d> from =
            read_transform(file_, child_user, of_child, *child_units);
        if (!from) return from.error();
        const Result<Eigen::Affine3d> to =
            read_transform(file_, parent_user, of_parent, *parent_units);
        if (!to) return to.error();
        return Eigen::Affine3d(*to * from->inverse());
    }

    Result<Eigen::Affine3d> related_placement(const Link& link, const Relationship& r) {
        if (is_operator(file_, r.transformation)) {
            const Result<Units> units = units_.of_context(table_[r.second].context);
            if (!units) return units.error();
            const Result<Eigen::Affine3d> t =
                read_transform(file_, r.instance, r.transformation, *units);
            if (!t) return t.error();
            return link.child_is_first ? *t : Eigen::Affine3d(t->inverse());
        }
        if (keyword(file_, r.transformation) != "ITEM_DEFINED_TRANSFORMATION") {
            return unexpected(file_, r.instance, "ITEM_DEFINED_TRANSFORMATION", r.transformation);
        }
        Fields fields(file_, r.transformation, 4);
        InstanceIndex of_first = fields.reference(2), of_second = fields.reference(3);
        if (!fields.ok()) return fields.error();
        // Some writers exchange the two; each is an item of the representation that it belongs to.
        const auto lists = [&](RepresentationId id, InstanceIndex item) {
            const auto& placements = table_[id].placements;
            return std::find(placements.begin(), placements.end(), item) != placements.end();
        };
        const bool exchanged = lists(r.second, of_first) && !lists(r.first, of_first) &&
                               lists(r.first, of_second) && !lists(r.second, of_second);
        if (exchanged && !places_by_first(link, of_first, of_second)) {
            std::swap(of_first, of_second);
        }
        return between(link, link.child_is_first ? of_first : of_second, r.transformation,
                       link.child_is_first ? of_second : of_first, r.transformation);
    }

    // Other writers name the assembly first, with the part's place in it as the first item, but list this place with
    // the part and the assembly's own origin with the assembly.
    bool places_by_first(const Link& link, InstanceIndex of_first, InstanceIndex of_second) {
        if (link.child_is_first) return false;
        const auto is_origin = [&](InstanceIndex item) {
            const auto place = read_transform(file_, link.relationship->instance, item, Units{});
            return place && same_place(*place, Eigen::Affine3d::Identity());
        };
        return !is_origin(of_first) && is_origin(of_second);
    }

    void emit(RepresentationId id, const Eigen::Affine3d& placement) {
        const Group& g = group(id);
        for (const auto& [item, representation] : g.items) {
            placed_.push_back(
                {item, table_[representation].context, placement, product_name(file_, g.product)});
        }
        for (const std::size_t i : g.links) emit(links_[i].child, placement * *links_[i].placement);
    }

    void add_loose_items() {
        for (const std::string_view type :
             {"MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP", "SHELL_BASED_SURFACE_MODEL",
              "FACE_BASED_SURFACE_MODEL"}) {
            for (const InstanceIndex item : file_.instances_of(type)) {
                if (kind_of(file_, item) == ItemKind::other || !listed_.insert(item.value).second)
                    continue;
                diagnostics_.push_back(
                    warning(file_, item, named(file_, item) + " is in no representation"));
                placed_.push_back({item, InstanceIndex(), Eigen::Affine3d::Identity(), {}});
            }
        }
    }

    const File& file_;
    RepresentationTable table_;
    UnitTable& units_;
    Diagnostics& diagnostics_;
    part21::Trail trail_;
    std::vector<Group> groups_;  // by the representation that stands for the group
    std::vector<Link> links_;
    std::unordered_set<std::uint32_t> listed_;            // items in any representation
    std::unordered_set<std::uint32_t> listed_by_shapes_;  // in one that is not only a usage's
    std::unordered_map<std::uint32_t, const Usage*> usage_by_instance_;
    std::vector<Placed> placed_;
};

}  // namespace

Result<std::vector<Placed>> placed_items(const File& file, UnitTable& units,
                                         Diagnostics& diagnostics) {
    Result<RepresentationTable> table = RepresentationTable::read(file);
    if (!table) return table.error();
    return Structure(file, std::move(*table), units, diagnostics).unfold();
}

}  // namespace lyr::importer
