#include "api/openapi/words.hpp"

#include "core/measures/regime.hpp"

namespace vines::api::document {

Json regime_name() {
    std::vector<std::string> names;
    for (const RegimeType type :
         {RegimeType::none, RegimeType::I, RegimeType::II, RegimeType::III, RegimeType::IV,
          RegimeType::V, RegimeType::VI})
        names.push_back(name_of(type));
    return one_of(names);
}

Json side() { return {{"type", "integer"}, {"enum", {1, -1}}}; }

}  // namespace vines::api::document
