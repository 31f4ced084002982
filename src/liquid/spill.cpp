#include "liquid/spill.h"

#include <cmath>
#include <map>

#include "liquid/drops.h"
#include "liquid/films.h"

namespace calot {

int spill(Field& field, double duration) {
  Spill& all = field.spill;
  forget_films_of_gone(field);
  constexpr double longest_part = 5e-3;  // s
  const int parts = std::max(1, static_cast<int>(std::ceil(duration / longest_part - 1e-9)));
  const double part = duration / parts;
  std::optional<FallenOn> skins;
  std::map<int, FilmFlow> flows;
  int looks = 0;
  for (int k = 0; k < parts; ++k) {
    if (!all.drops.empty() && !skins) skins.emplace(field);
    std::erase_if(all.drops, [&](Drop& drop) { return fall(field, *skins, drop, part); });
    for (Film& film : all.films) {
      if (lies_still(field, film, part)) continue;
      auto at = flows.find(film.on);
      if (at == flows.end())
        at = flows.emplace(film.on, FilmFlow(wet_surface(field, film.on), field.up)).first;
      const bool moved = at->second.run(film, part, all.drops);
      film.rest = moved ? std::nullopt : std::optional(rest_of(field, film, part));
      ++looks;
    }
  }
  let_fall(field, duration, skins);
  return looks;
}

}  // namespace calot
