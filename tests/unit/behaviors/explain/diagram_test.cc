// State diagrams: what is in them, and that both writers' texts say it.
#include "behaviors/explain/diagram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

namespace footfall::behaviors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Diagram diagram_of(const std::string& text) {
  core::Diagnostics diagnostics;
  auto diagram = load_diagram_text(text, "chart.yaml", {}, diagnostics);
  EXPECT_TRUE(diagram) << diagnostics.to_string();
  return diagram.value_or(Diagram{});
}

const DiagramState& state_of(const Diagram& diagram, const std::string& path) {
  for (const DiagramState& state : diagram.states) {
    if (state.path == path) return state;
  }
  ADD_FAILURE() << "no state " << path;
  return diagram.states.front();
}

const char* const kParallel = R"(behavior: 1
parameters: {pause: 24 ms}
events: {go: "", stop: "", back: "", both: ""}
machine:
  safe: limp
  transitions: [{on: stop, to: limp}]
  states:
    idle:
      on_entry: [{mark: here}]
      transitions:
        - {on: go, when: "time > 1 s", to: work, do: [{raise: back}]}
        - {on: both, to: [walk.b, look.far]}
        - {on: back, do: [{log: "a <b> & \"c\""}]}
    work:
      type: parallel
      states:
        walk: {states: {a: {after: $pause, to: b}, b: {}}}
        look:
          states:
            near: {transitions: [{on: back, to: far}]}
            far: {transitions: [{on: back, to: near}]}
            memory: {type: history, depth: deep, default: far}
    limp: {}
    end: {type: final}
)";

TEST(Diagram, SaysWhatTheFileSays) {
  const Diagram diagram = diagram_of(kParallel);
  EXPECT_TRUE(state_of(diagram, "limp").safe);
  EXPECT_FALSE(state_of(diagram, "idle").safe);
  EXPECT_TRUE(state_of(diagram, "work.walk").region);
  EXPECT_THAT(state_of(diagram, "idle").actions,
              ElementsAre("entry / mark here", "back / log \"a <b> & \"c\"\""));
  ASSERT_EQ(diagram.edges.size(), 6U);  // stop, go, both, pause, back, back
  EXPECT_THAT(diagram.edges[1].label, ElementsAre("go", "[time > 1 s]", "/ raise back"));
  EXPECT_EQ(diagram.edges[2].targets.size(), 2U);
  EXPECT_THAT(diagram.edges[3].label, ElementsAre("after $pause = 24 ms"));
}

TEST(Diagram, ATemplatesInstanceNamesItsTemplateAndArguments) {
  const Diagram diagram = diagram_of(R"(behavior: 1
templates: {wait: {args: [long], states: {a: {after: $long, to: b}, b: {type: final}}}}
machine: {states: {one: {use: wait, with: {long: 5 ms}, transitions: [{on: done.state.one, to: two}]}, two: {}}}
)");
  EXPECT_EQ(state_of(diagram, "one").origin, "wait(long: 5 ms)");
  EXPECT_EQ(state_of(diagram, "two").origin, "");
}

// The position of the line that begins with `text` after blanks; npos if there is none.
std::size_t line_of(const std::string& text, const std::string& line) {
  return text.find("\n" + line);
}

TEST(Diagram, DotNestsClustersAndMarksRegionsHistoryAndFinalStates) {
  const Diagram diagram = diagram_of(kParallel);
  const std::string dot = to_dot(diagram);
  // work is state 2, its regions 3 and 6: clusters inside one another, closed in order.
  const std::size_t work = line_of(dot, "  subgraph cluster_2 {");
  const std::size_t walk = line_of(dot, "    subgraph cluster_3 {");
  const std::size_t look = line_of(dot, "    subgraph cluster_6 {");
  ASSERT_NE(work, std::string::npos);
  ASSERT_NE(walk, std::string::npos);
  ASSERT_NE(look, std::string::npos);
  EXPECT_LT(work, walk);
  EXPECT_LT(walk, look);
  EXPECT_THAT(dot, HasSubstr("style=\"rounded,filled,dashed\""));
  EXPECT_THAT(dot, HasSubstr("shape=doublecircle"));
  EXPECT_THAT(dot, HasSubstr("<B>H*</B>"));
  EXPECT_THAT(dot, HasSubstr("compound=true"));
  EXPECT_THAT(dot, HasSubstr("lhead=cluster_2"));
  EXPECT_THAT(dot, HasSubstr("a &lt;b&gt; &amp; &quot;c&quot;"));
  EXPECT_EQ(std::ranges::count(dot, '{'), std::ranges::count(dot, '}'));
}

TEST(Diagram, MermaidSeparatesRegionsAndEscapesWhatItsGrammarUses) {
  const std::string mermaid = to_mermaid(diagram_of(kParallel));
  EXPECT_THAT(mermaid, HasSubstr("\nstateDiagram-v2\n"));
  EXPECT_THAT(mermaid, HasSubstr("\n    --\n"));
  EXPECT_THAT(mermaid, HasSubstr("state \"H*\""));
  EXPECT_THAT(mermaid, HasSubstr("#60;b#62; #38; #34;c#34;"));
  // After the arrow's colon no further one, and nothing that ends a statement.
  std::istringstream lines(mermaid);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t arrow = line.find("-->");
    if (arrow == std::string::npos) continue;
    const std::string label = std::regex_replace(line.substr(arrow + 3), std::regex("#\\d+;"), "");
    EXPECT_LE(std::ranges::count(label, ':'), 1) << line;
    EXPECT_EQ(label.find_first_of(";\"<>"), std::string::npos) << line;
  }
}

// Mermaid 12 draws what is inside a composite state over the second line of its title.
TEST(Diagram, ATitleOfACompositeStateIsOneLineInMermaid) {
  const std::string mermaid = to_mermaid(diagram_of(
      "behavior: 1\nmachine:\n  states:\n    a: {on_entry: [{mark: m}], after: 1 s, to: b, states: "
      "{c: {on_entry: [{mark: n}]}}}\n    b: {type: final}\n"));
  EXPECT_THAT(mermaid, HasSubstr("state \"a · entry / mark m\" as s1 {"));
  EXPECT_THAT(mermaid, HasSubstr("state \"c<br/>entry / mark n\" as s2"));
}

TEST(Diagram, AClosedStateIsOneBoxWithItsOwnTransitions) {
  std::string why;
  const auto closed = close_states(diagram_of(kParallel), {"machine"}, why);
  ASSERT_TRUE(closed) << why;
  ASSERT_EQ(closed->states.size(), 5U);  // root, idle, work, limp, end
  EXPECT_EQ(state_of(*closed, "work").closed, 7);
  EXPECT_TRUE(state_of(*closed, "work").children.empty());
  ASSERT_EQ(closed->edges.size(), 3U);  // stop, go, both; the rest goes on inside work
  EXPECT_EQ(closed->edges[2].targets.size(), 1U);
}

TEST(Diagram, AnOpenStateIsShownWithWhatItIsIn) {
  std::string why;
  const auto open = close_states(diagram_of(kParallel), {"look"}, why);
  ASSERT_TRUE(open) << why;
  EXPECT_FALSE(state_of(*open, "work.look").children.empty());
  EXPECT_EQ(state_of(*open, "work.walk").closed, 2);
  EXPECT_FALSE(close_states(diagram_of(kParallel), {"lok"}, why));
  EXPECT_THAT(why, HasSubstr("did you mean 'look'"));
}

}  // namespace
}  // namespace footfall::behaviors
