#include "session/json.h"

namespace calot {

std::string json_text(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

OrderedJson problems_json(const Failure& failure) {
  OrderedJson list = OrderedJson::array();
  for (const Problem& problem : failure.problems) {
    list.push_back({{"file", problem.place.file},
                    {"line", problem.place.line},
                    {"path", problem.place.path},
                    {"message", problem.message},
                    {"hint", problem.hint}});
  }
  return list;
}

}  // namespace calot
