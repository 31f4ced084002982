// Which shape is whose.

#include "tools/field_shape.h"

#include <gtest/gtest.h>

#include "field_rig.h"
#include "motion/settle_field.h"

namespace calot {
namespace {

static_assert(!std::is_convertible_v<int, ToolIndex> && !std::is_convertible_v<OrganIndex, ToolIndex> &&
                  !std::is_convertible_v<int, OrganIndex> && !std::is_convertible_v<ToolIndex, OrganIndex>,
              "a tool and an organ, or a number, cannot stand for each other");

/// A ball, two graspers and two pieces of ground.
Field field_of_all() {
  Field field = test::make_field(test::held_ball(), 1e-6, Vec3::UnitZ());
  test::add_grasper(field, Vec3(0, -150e-3, 20e-3));
  test::add_grasper(field, Vec3(0, 150e-3, 20e-3));
  for (double depth : {0.2, 0.3})
    field.ground.push_back({"floor", Plane{Vec3(0, 0, -depth), Vec3::UnitZ()}, 0, true});
  return field;
}

TEST(FieldShape, NamesEachShapeOfABodyAsItsLoadsHaveIt) {
  const Field field = field_of_all();
  const ContactLoads loads = contact_loads(field, field.organs[0], present_poses(field));
  ASSERT_EQ(loads.shapes.size(), 8u);
  for (int index = 0; index < 8; ++index) {
    const FieldShape which = field.shape(index);
    const Tool& tool = field.tool(which.is_ground() ? ToolIndex(0) : which.tool);
    const Shape made =
        which.is_ground() ? field.ground[which.ground].shape : shapes_in_field(tool, tool.pose)[which.part];
    EXPECT_EQ(loads.shapes[index], contact_shape(made)) << index;
    EXPECT_EQ(loads.is_broad(index), which.is_ground()) << index;
    EXPECT_EQ(which.index(field.tools.size()), index);
  }
}

TEST(FieldShape, IsAShaftAJawOrGround) {
  const Field field = field_of_all();
  for (int jaw : {0, 1}) {
    const FieldShape of_second = field.shape(FieldShape::of_jaw(ToolIndex(1), jaw).index(field.tools.size()));
    EXPECT_EQ(of_second, FieldShape::of_tool(ToolIndex(1), jaw + 1));
    EXPECT_EQ(of_second.jaw(), jaw);
    EXPECT_FALSE(of_second.is_shaft() || of_second.is_ground());
  }
  EXPECT_TRUE(field.shape(FieldShape::of_tool(ToolIndex(1), 0).index(field.tools.size())).is_shaft());
  const FieldShape second_floor = field.shape(7);
  EXPECT_EQ(second_floor, FieldShape::of_ground(1));
  EXPECT_TRUE(second_floor.is_ground() && !second_floor.is_shaft());
}

}  // namespace
}  // namespace calot
