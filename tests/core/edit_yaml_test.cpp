// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/fields/edit_yaml.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "assets/assets.h"
#include "core/error.h"
#include "core/fields/yaml.h"

namespace greatx {
namespace {

using Kind = YamlChange::Kind;

const std::string sample =
    "# A comment at the top.\n"
    "name: first  # the name\n"
    "sun: {azimuth_deg: -60, elevation_deg: 48}  # both\n"
    "nodes:\n"
    "  # the mast\n"
    "  - name: bs\n"
    "    trajectory: {type: static, position_m: [13, 13, 0]}\n"
    "  - {name: \"u, v\", sensors: []}  # a drone\n"
    "channels:\n"
    "  - name: csi\n"
    "    outputs: [cfr, # the response\n"
    "              paths]\n";

std::string set(const std::string& text, const std::string& path, const std::string& value) {
  const EditedYaml edited = edit_yaml(text, {Kind::set, parse_yaml_path(path), value});
  EXPECT_TRUE(edited.kept_comments) << path;
  return edited.text;
}
std::string replaced(std::string text, const std::string& before, const std::string& after) {
  const size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  return text.replace(at, before.size(), after);
}

TEST(EditYaml, ReplacesAValueAndNothingElse) {
  EXPECT_EQ(set(sample, "sun.elevation_deg", "-3.5"),
            replaced(sample, "elevation_deg: 48", "elevation_deg: -3.5"));
  EXPECT_EQ(set(sample, "name", "second"), replaced(sample, "name: first", "name: second"));
  EXPECT_EQ(set(sample, "nodes[0].trajectory.position_m", "[1, 2, 3]"),
            replaced(sample, "[13, 13, 0]", "[1, 2, 3]"));
  EXPECT_EQ(set(sample, "nodes[1].name", "w"), replaced(sample, "\"u, v\"", "w"));
  EXPECT_EQ(set(sample, "channels[0].outputs", "[cfr]"),
            replaced(sample, "[cfr, # the response\n              paths]", "[cfr]"));
}

TEST(EditYaml, MakesMissingMapsOnTheWay) {
  EXPECT_EQ(set(sample, "sun.illuminance_lux", "9e4"),
            replaced(sample, "elevation_deg: 48}", "elevation_deg: 48, illuminance_lux: 9e4}"));
  EXPECT_EQ(set(sample, "nodes[0].class", "mast"),
            replaced(sample, "[13, 13, 0]}\n", "[13, 13, 0]}\n    class: mast\n"));
  EXPECT_EQ(set(sample, "effects.diffraction", "on"), sample + "effects: {diffraction: on}\n");
  EXPECT_EQ(edit_yaml("", {Kind::set, parse_yaml_path("a.b"), "1"}).text, "a:\n  b: 1\n");
}

TEST(EditYaml, InsertsAndRemovesItems) {
  const auto change = [](Kind kind, const std::string& path, const std::string& value = "") {
    const EditedYaml edited = edit_yaml(sample, {kind, parse_yaml_path(path), value});
    EXPECT_TRUE(edited.kept_comments) << path;
    return edited.text;
  };
  EXPECT_EQ(change(Kind::insert, "nodes[2]", "{name: car}"),
            replaced(sample, "# a drone\n", "# a drone\n  - {name: car}\n"));
  EXPECT_EQ(change(Kind::insert, "nodes[1]", "{name: car}"),
            replaced(sample, "  - {name: \"u", "  - {name: car}\n  - {name: \"u"));
  EXPECT_EQ(change(Kind::insert, "nodes[1].sensors[0]", "a"), replaced(sample, "[]", "[a]"));
  EXPECT_EQ(change(Kind::insert, "channels[0].outputs[0]", "taps"), replaced(sample, "[cfr", "[taps, cfr"));
  EXPECT_EQ(change(Kind::remove, "nodes[1]"),
            replaced(sample, "  - {name: \"u, v\", sensors: []}  # a drone\n", ""));
  EXPECT_EQ(change(Kind::remove, "sun.azimuth_deg"), replaced(sample, "azimuth_deg: -60, ", ""));
  EXPECT_EQ(change(Kind::remove, "sun.elevation_deg"), replaced(sample, ", elevation_deg: 48", ""));
  EXPECT_EQ(change(Kind::remove, "sun"),
            replaced(sample, "sun: {azimuth_deg: -60, elevation_deg: 48}  # both\n", ""));
  EXPECT_EQ(change(Kind::remove, "nodes[0].name"), replaced(sample, "name: bs\n    ", ""));
}

TEST(EditYaml, WritesAnewWhatCannotBeChangedInPlace) {
  const std::string shared = "# gone\na: &x {b: 1}\nc: *x\n";
  const EditedYaml edited = edit_yaml(shared, {Kind::set, parse_yaml_path("c.b"), "2"});
  EXPECT_FALSE(edited.kept_comments);
  EXPECT_EQ(yaml_line(*read_yaml(edited.text, "edited")), "{a: {b: 1}, c: {b: 2}}");
  const EditedYaml folded = edit_yaml("a: one\n  two\nb: 1\n", {Kind::set, parse_yaml_path("a"), "3"});
  EXPECT_EQ(yaml_line(*read_yaml(folded.text, "edited")), "{a: 3, b: 1}");
}

TEST(EditYaml, NamesWhatIsWrong) {
  const auto message = [](const std::string& path, const std::string& value) {
    try {
      edit_yaml(sample, {Kind::set, parse_yaml_path(path), value});
      return std::string("no error");
    } catch (const UserError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(message("nodes[7].name", "x"), "nodes[7].name: expected an index below 2, found 7");
  EXPECT_EQ(message("name.x", "x"), "name.x: expected a map on the way");
  EXPECT_EQ(message("sun", "1\n2"), "sun: expected a value on one line");
  EXPECT_NE(message("sun", "{a: "), "no error");
  EXPECT_THROW(parse_yaml_path("a[b]"), UserError);
  EXPECT_THROW(parse_yaml_path(""), UserError);
  EXPECT_THROW(parse_yaml_path("a..b"), UserError);
}

/// Lists the path of every value of a document.
void all_paths(const FieldValue& value, const YamlPath& here, std::vector<YamlPath>& paths) {
  if (!here.empty()) paths.push_back(here);
  const auto below = [&](YamlStep step, const FieldValue& inner) {
    YamlPath path = here;
    path.push_back(std::move(step));
    all_paths(inner, path, paths);
  };
  for (size_t i = 0; i < value.items.size(); ++i) below(i, *value.items[i]);
  for (const FieldValue::Member& member : value.members) below(member.key, *member.value);
}

TEST(EditYaml, ChangesValuesOfEveryEmbeddedScenarioInPlace) {
  constexpr size_t every = 5;  // other values of each scenario, since the scenarios resemble each other
  size_t turn = 0;
  for (const EmbeddedScenario& scenario : embedded_scenarios()) {
    const std::string text(scenario.text);
    std::vector<YamlPath> paths;
    all_paths(*read_yaml(text, "scenario"), {}, paths);
    for (size_t i = turn++ % every; i < paths.size(); i += every) {
      const YamlPath& path = paths[i];
      const std::string where = std::string(scenario.name) + ": " + yaml_path_text(path);
      EXPECT_EQ(parse_yaml_path(yaml_path_text(path)), path);
      const EditedYaml edited = edit_yaml(text, {Kind::set, path, "[new, {value: 1}]"});
      EXPECT_TRUE(edited.kept_comments) << where;
      const auto value = value_at(read_yaml(edited.text, "edited"), path);
      ASSERT_NE(value, nullptr) << where;
      EXPECT_EQ(yaml_line(*value), "[new, {value: 1}]") << where;
      // The old value, put back, gives the same document.
      const std::string old = yaml_line(*value_at(read_yaml(text, "scenario"), path));
      const EditedYaml back = edit_yaml(edited.text, {Kind::set, path, old});
      EXPECT_TRUE(same_values(*read_yaml(back.text, "back"), *read_yaml(text, "scenario"))) << where;
      EXPECT_NO_THROW(edit_yaml(text, {Kind::remove, path, ""})) << where;
      if (std::holds_alternative<size_t>(path.back())) {
        EXPECT_TRUE(edit_yaml(text, {Kind::insert, path, "x"}).kept_comments) << where;
      }
    }
  }
}

}  // namespace
}  // namespace greatx
