// See trail.h.

#include "parser/part21/trail.h"

#include <algorithm>

namespace lyr::part21 {

Result<Trail::Step> Trail::enter(InstanceIndex instance) {
    if (entered_[instance.value]) {
        constexpr std::ptrdiff_t longest = 8;  // names in the message
        const auto first = std::find(path_.begin(), path_.end(), instance);
        const auto name = [this](InstanceIndex i) { return '#' + std::to_string(file_->id(i)); };
        std::string message = name(instance) + " refers to itself: " + name(instance);
        for (auto i = first + 1; i < path_.end(); ++i) {
            if (i - first > longest) {
                message += " -> ...";
                break;
            }
            message += " -> " + name(*i);
        }
        return file_->error(instance, message + " -> " + name(instance));
    }
    if (path_.size() >= max_length) {
        return file_->error(instance, "this instance is reached by more than " +
                                          std::to_string(max_length) + " references in a row");
    }
    entered_[instance.value] = true;
    path_.push_back(instance);
    return Step(this);
}

void Trail::leave() {
    entered_[path_.back().value] = false;
    path_.pop_back();
}

}  // namespace lyr::part21
