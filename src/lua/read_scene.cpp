#include "lua/read_scene.h"

#include <fmt/format.h>

#include "base/suggest.h"
#include "lua/table_reader.h"
#include "script/safe_path.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

class SceneReader {
 public:
  SceneReader(FieldCheck& check, const MeshFolders& folders) : check_(check), folders_(folders) {}

  SceneDefinition read(const Value& value) {
    SceneDefinition scene;
    const TableReader reader(check_, &value, "scene", api_table("scene"));
    if (const Value* anatomy = reader.take("anatomy"))
      scene.anatomy = read_anatomy(*anatomy, "scene.anatomy");
    if (const Value* ports = reader.take("ports")) scene.ports = read_ports(*ports);
    if (const Value* instruments = reader.take("instruments"))
      scene.instruments = read_instruments(*instruments);
    reader.read(scene);
    return scene;
  }

  void read_organ(OrganDefinition& organ, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("organ"));
    if (const Value* bile = reader.take("bile")) forget_filling(organ.bile, *bile);
    reader.read(organ);
    if (const Value* shape = reader.take("shape")) read_shape(organ.shape, *shape, path + ".shape");
    lay_along(reader, organ);
    if (const Value* held = reader.take("held")) organ.held = read_held(*held, path + ".held");
    read_vessels(reader, organ.vessels);
    if (const Value* injury = reader.take("injury")) {
      const TableReader of(check_, injury, path + ".injury", api_table("injury"));
      of.read(organ.injury);
      read_list(of, "near_start", "injury_near_start", organ.injury.near_start);
      read_list(of, "together", "injury_together", organ.injury.together);
    }
  }

 private:
  /// A swept organ's axis says where its neck and its fundus are.
  void lay_along(const TableReader& reader, OrganDefinition& organ) {
    const auto* swept = std::get_if<SweptShape>(&organ.shape);
    if (swept == nullptr || swept->along.empty()) return;
    for (const char* end : {"neck", "fundus"})
      if (reader.has(end))
        check_.problem(reader.path_of(end), fmt::format("a swept organ's {} is an end of its axis", end),
                       fmt::format("leave {} out", end));
    organ.neck = swept->along.front().at;
    organ.fundus = swept->along.back().at;
  }

  AnatomyDefinition read_anatomy(const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("anatomy"));
    AnatomyDefinition anatomy;
    std::string base;
    reader.take("base", base);
    // An unknown one has been reported; the usual one keeps what follows from being reported too.
    if (value.field("base") != nullptr && base.empty()) base = anatomy_names().front();
    if (!base.empty()) {
      Result<AnatomyDefinition> named = named_anatomy(base);
      if (named) anatomy = std::move(named).value();
    }
    reader.read(anatomy);
    if (const Value* organs = reader.take("organs")) {
      for (std::size_t i = 0; i < organs->items.size(); ++i) {
        const bool overrides = i < anatomy.organs.size();
        if (!overrides) anatomy.organs.emplace_back();
        read_organ(anatomy.organs[i], organs->items[i], indexed(path + ".organs", i));
      }
    }
    read_list(reader, "joints", "joint", anatomy.joints);
    read_list(reader, "leaves", "leaf", anatomy.leaves);
    read_list(reader, "tissue", "tissue", anatomy.tissue);
    read_list(reader, "ground", "ground", anatomy.ground);
    return anatomy;
  }

  /// Tables of one kind, which replace those that there are.
  template <class T>
  void read_list(const TableReader& reader, const std::string& key, const std::string& of,
                 std::vector<T>& out) {
    const Value* list = reader.take(key);
    if (list == nullptr) return;
    out.clear();
    for (std::size_t i = 0; i < list->items.size(); ++i)
      TableReader(check_, &list->items[i], indexed(reader.path_of(key), i), api_table(of))
          .read(out.emplace_back());
  }

  /// One of volume and pressure given here replaces whichever the anatomy had.
  void forget_filling(BileDefinition& bile, const Value& value) {
    if (value.field("fill_volume") == nullptr && value.field("fill_pressure") == nullptr) return;
    bile.fill_volume.reset();
    bile.fill_pressure.reset();
  }

  std::vector<HeldRegion> read_held(const Value& list, const std::string& path) {
    std::vector<HeldRegion> regions;
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      HeldRegion region;
      const TableReader reader(check_, &list.items[i], indexed(path, i), api_table("held"));
      reader.read(region);
      // Without a fit landmark the reader has said so already; validation would only repeat it.
      if (region.landmark.empty()) region.landmark = organ_landmarks().front();
      regions.push_back(region);
    }
    return regions;
  }

  /// Keeps the shape there was where the type is the same or left out: an override gives only what differs.
  void read_shape(OrganShape& shape, const Value& value, const std::string& path) {
    const std::string present = shape_name(shape);
    const Value* type = value.field("type");
    std::string wanted = type != nullptr && type->is(Value::Kind::text) ? type->text : present;
    const std::vector<std::string>& types = api_table("shape_pear").find("type")->choices;
    if (std::find(types.begin(), types.end(), wanted) == types.end()) {
      check_.known(path + ".type", wanted, types, "shape");
      return;
    }
    const TableReader reader(check_, &value, path, api_table("shape_" + wanted));
    if (wanted == "pear") {
      if (wanted != present) shape = PearShape{};
      reader.read(std::get<PearShape>(shape));
    } else if (wanted == "sphere") {
      if (wanted != present) shape = SphereShape{};
      reader.read(std::get<SphereShape>(shape));
    } else if (wanted == "swept") {
      if (wanted != present) shape = SweptShape{};
      auto& swept = std::get<SweptShape>(shape);
      reader.read(swept);
      read_list(reader, "along", "station", swept.along);
    } else if (wanted == "tube") {
      if (wanted != present) shape = TubeShape{};
      read_tube(reader, std::get<TubeShape>(shape));
    } else if (wanted == "rigid") {
      if (wanted != present) shape = RigidShape{};
      auto& rigid = std::get<RigidShape>(shape);
      reader.read(rigid);
      read_path(reader, rigid.path);
    } else if (wanted == "lobe") {
      if (wanted != present) shape = LobeShape{};
      reader.read(std::get<LobeShape>(shape));
    } else {
      if (wanted != present) shape = MeshFile{};
      MeshFile& mesh = std::get<MeshFile>(shape);
      reader.read(mesh);
      read_path(reader, mesh.path);
    }
  }

  /// Of a mesh file, where one is named.
  void read_path(const TableReader& reader, std::string& out) {
    std::string file;
    reader.take("path", file);
    if (!file.empty()) out = find_mesh(file, reader.path_of("path"));
  }

  /// A list replaces the radii that there were, and a radius the list.
  void read_radii(const TableReader& reader, TubeShape& tube) {
    const Value* radii = reader.take("radii");
    if (radii == nullptr && (reader.has("radius") || reader.has("end_radius"))) tube.radii.clear();
    if (radii == nullptr) return;
    if (reader.has("radius"))
      check_.problem(reader.path_of("radius"), "radius and radii are both given", "leave one out");
    tube.radii.clear();
    if (!reader.has("end_radius")) tube.end_radius = 0;
    for (std::size_t i = 0; i < radii->items.size(); ++i) {
      const Value& item = radii->items[i];
      if (item.is(Value::Kind::number)) {
        tube.radii.push_back(item.number);
      } else {
        check_.problem(indexed(reader.path_of("radii"), i), "this is no radius",
                       "give numbers, such as 2.5 * mm");
      }
    }
  }

  void read_tube(const TableReader& reader, TubeShape& tube) {
    reader.read(tube);
    read_radii(reader, tube);
    read_points(reader, tube.points);
  }

  /// Of "points", which replaces those that there are.
  void read_points(const TableReader& reader, std::vector<Vec3>& out) {
    const Value* points = reader.take("points");
    if (points == nullptr) return;
    out.clear();
    for (std::size_t i = 0; i < points->items.size(); ++i)
      if (const std::optional<Vec3> at =
              read_point(check_, points->items[i], indexed(reader.path_of("points"), i)))
        out.push_back(*at);
  }

  void read_vessels(const TableReader& reader, std::vector<WallVessel>& out) {
    const Value* vessels = reader.take("vessels");
    if (vessels == nullptr) return;
    out.clear();
    for (std::size_t i = 0; i < vessels->items.size(); ++i) {
      const TableReader of(check_, &vessels->items[i], indexed(reader.path_of("vessels"), i),
                           api_table("wall_vessel"));
      of.read(out.emplace_back());
      read_points(of, out.back().points);
    }
  }

  std::string find_mesh(const std::string& file, const std::string& path) {
    const fs::path name(file);
    for (const fs::path& folder : {folders_.scenario, folders_.assets}) {
      if (folder.empty() || name.is_absolute() || !fs::is_regular_file(folder / name)) continue;
      if (is_inside(folder / name, folder)) return (folder / name).string();
    }
    if (folders_.scenario.empty() && folders_.assets.empty()) {
      check_.problem(path, "what steps add is read from no mesh file",
                     "put the organ into the scene, or add a ball, a box, a ring or a tube");
      return file;
    }
    check_.problem(
        path, fmt::format("there is no mesh file \"{}\"", file),
        fmt::format("give a path below {} or {}", folders_.scenario.string(), folders_.assets.string()));
    return file;
  }

  std::vector<PortDefinition> read_ports(const Value& map) {
    std::vector<PortDefinition> ports = default_ports();
    for (const auto& [name, value] : map.fields) {
      const std::optional<Vec3> position = read_point(check_, value, "scene.ports." + name);
      if (!position) continue;
      const auto same = [&own = name](const PortDefinition& port) { return port.name == own; };
      const auto known = std::find_if(ports.begin(), ports.end(), same);
      if (known == ports.end()) {
        ports.push_back({name, *position});
      } else {
        known->position = *position;
      }
    }
    return ports;
  }

  /// Sorted by name: the order of a table's keys is none.
  std::vector<InstrumentDefinition> read_instruments(const Value& map) {
    std::vector<InstrumentDefinition> instruments;
    for (const auto& [name, value] : map.fields) {
      const std::string path = "scene.instruments." + name;
      const TableReader reader(check_, &value, path, api_table("instrument"));
      std::string type = to_text(InstrumentType::atraumatic_grasper);
      reader.take("type", type);
      InstrumentDefinition instrument = default_instrument(*instrument_type_called(type));
      instrument.name = name;
      reader.read(instrument);
      check_owners(reader, instrument.type);
      check_free(path, name);
      instruments.push_back(instrument);
    }
    return instruments;
  }

  /// Complains of keys that mean nothing to an instrument of this type.
  void check_owners(const TableReader& reader, InstrumentType type) {
    using enum InstrumentAction;
    const auto check = [&](KeyOwner owner, bool is_owner, const char* lacks, const char* instead) {
      for (const Key& key : api_table("instrument").keys)
        if (key.owner == owner && !is_owner && reader.has(key.name))
          check_.problem(reader.path_of(key.name), fmt::format("its type {} {}", to_text(type), lacks),
                         fmt::format("leave {} out{}", key.name, instead));
    };
    check(KeyOwner::jaws, has_jaws(type), "has no jaws to pinch with", "");
    check(KeyOwner::clips, has_action(type, fire), "sets no clips", ", or make it a clip_applier");
    check(KeyOwner::needle, has_action(type, aspirate), "draws nothing out",
          ", or make it an aspiration_needle");
    check(KeyOwner::current, has_action(type, activate), "carries no current",
          ", or make it an l_hook, semm_forceps or a bipolar_electrode");
  }

  void check_free(const std::string& path, const std::string& name) {
    for (const char* class_name : {"Steps", "Demo"}) {
      const std::vector<std::string> methods = method_names(class_name);
      if (std::find(methods.begin(), methods.end(), name) == methods.end()) continue;
      return check_.problem(path, fmt::format("\"{}\" is a method of t and cannot name an instrument", name),
                            "use another name, such as left or right");
    }
  }

  FieldCheck& check_;
  const MeshFolders& folders_;
};

}  // namespace

SceneDefinition read_scene(FieldCheck& check, const Value& scene, const MeshFolders& folders) {
  return SceneReader(check, folders).read(scene);
}

OrganDefinition read_organ(FieldCheck& check, const Value& organ, const std::string& path,
                           const MeshFolders& folders) {
  OrganDefinition definition;
  SceneReader(check, folders).read_organ(definition, organ, path);
  return definition;
}

}  // namespace calot
