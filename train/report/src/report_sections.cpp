// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "report_sections.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/report/html_numbers.h"
#include "doorforge/report/outcome_text.h"
#include "doorforge/schemas/episode_film.h"

#include "report_charts.h"

namespace doorforge::internal {
namespace {

using Episodes = std::span<const EvaluatedEpisode>;

// Whether somebody's own class opens, and no folder of weights.
bool IsOwn(const EvaluationReport& report) {
  return !IsExpert(report) && report.provenance.policy_sha256.empty();
}

std::string PolicyName(const EvaluationReport& report) {
  if (IsOwn(report)) return Escape(report.provenance.policy);
  return IsExpert(report) ? "rule-based expert" : "trained opener";
}

std::string PictureFigure(const ReportPicture& picture) {
  if (picture.png.empty()) return {};
  return Fill(
      R"(<figure><img src="{uri}" alt="{caption}"/><figcaption>{caption}</figcaption></figure>)",
      {{"uri", PngUri(picture.png)}, {"caption", Escape(picture.caption)}});
}

std::string FilmFigure(const ReportPictures& pictures, EpisodeOutcome outcome) {
  const auto film = pictures.episodes.find(outcome);
  if (film == pictures.episodes.end()) return {};
  std::string frames;
  for (const ReportPicture& frame : film->second.frames) frames += PictureFigure(frame);
  return Fill(
      R"(<figure><div class="film">{frames}</div><figcaption>{caption}</figcaption></figure>)",
      {{"frames", frames}, {"caption", Escape(film->second.caption)}});
}

std::string Figure(const std::string& number, const std::string& text, bool first = false) {
  return Fill(R"(<div class="figure{first}"><b>{number}</b><span>{text}</span></div>)",
              {{"first", first ? " first" : ""}, {"number", number}, {"text", text}});
}

std::string SpreadText(const SeedSpread& spread) {
  if (spread.rates.size() < 2) return "–";
  return Fixed(100 * spread.mean, 1) + " ± " + Fixed(100 * std::sqrt(spread.variance), 1) +
         "\u00a0%";
}

// one row of the table of what it took
std::string EffortRow(const std::string& name, Episodes episodes) {
  const SuccessSummary summary = Summarise(episodes);
  const std::string time =
      summary.opened.successes > 0 ? Fixed(summary.median_opening_s, 1) + "\u00a0s" : "–";
  return Fill(
      R"(<tr><td>{name}</td><td class="number">{handle} <span class="soft">[{interval}]</span></td>)"
      R"(<td class="number">{time}</td><td class="number">{force}</td><td class="number">{peak}</td></tr>)",
      {{"name", name},
       {"handle", Percent(summary.handle_turned.rate)},
       {"interval", IntervalText(summary.handle_turned)},
       {"time", time},
       {"force", Fixed(summary.median_force_n, 0) + "\u00a0N"},
       {"peak", Fixed(summary.peak_force_n, 0) + "\u00a0N"}});
}

// one row of the table of success
std::string SuccessRow(const std::string& name, Episodes episodes, Episodes reference,
                       bool overall) {
  const SuccessSummary summary = Summarise(episodes);
  const SuccessSummary expert = Summarise(reference);
  return Fill(
      R"(<tr{class}><td>{name}</td><td>{bar}</td><td class="number">{rate}</td>)"
      R"(<td class="number soft">{interval}</td><td class="number">{opened} / {episodes}</td>)"
      R"(<td class="number">{spread}</td>{expert}</tr>)",
      {{"class", overall ? R"( class="overall")" : ""},
       {"name", name},
       {"bar", RateBar(summary.opened, expert.opened)},
       {"rate", Percent(summary.opened.rate)},
       {"interval", IntervalText(summary.opened)},
       {"opened", std::to_string(summary.opened.successes)},
       {"episodes", std::to_string(summary.opened.episodes)},
       {"spread", SpreadText(summary.over_seeds)},
       {"expert", reference.empty()
                      ? ""
                      : R"(<td class="number">)" + Percent(expert.opened.rate) + "</td>"}});
}

std::string AngleRow(const std::string& name, Episodes episodes) {
  std::string cells;
  for (const AngleSuccess& angle : Summarise(episodes).over_angle) {
    cells +=
        Fill(R"(<td class="number">{rate} <span class="soft">[{interval}]</span></td>)",
             {{"rate", Percent(angle.success.rate)}, {"interval", IntervalText(angle.success)}});
  }
  return "<tr><td>" + name + "</td>" + cells + "</tr>";
}

// to the film of a row, on the page beside the report
std::string FilmLink(const EvaluatedEpisode& episode, const ReportPictures& pictures) {
  const std::string address = FilmAddress(episode.door_id, episode.seed, episode.episode);
  if (!pictures.filmed.contains(address)) return {};
  return " <a href=\"films.html#" + Escape(address) + "\">film</a>";
}

// a way to fail, how often, where, and a film strip of one such episode
std::string Cause(const EvaluationReport& report, const ReportPictures& pictures,
                  const FailureCause& cause) {
  const EvaluatedEpisode& example = report.episodes[cause.first];
  const double share =
      static_cast<double>(cause.episodes) / static_cast<double>(report.episodes.size());
  const std::string film = CanBeShown(cause.name) ? FilmFigure(pictures, example.outcome) : "";
  const std::string text = Fill(R"(<p class="soft">{door}, seed {seed}: {detail}{link}</p>)",
                                {{"door", Escape(example.door_id)},
                                 {"seed", std::to_string(example.seed)},
                                 {"detail", Escape(example.detail)},
                                 {"link", film.empty() ? FilmLink(example, pictures) : ""}});
  return Fill(
      R"(<div class="cause"><div class="head"><h3>{title}</h3><span>{count} of {all} episodes, {share}</span>)"
      R"(<span class="soft">{meaning}</span></div><div class="meter"><div style="width: {width}%"></div></div>{example}</div>)",
      {{"title", TextOf(cause.name).title},
       {"count", std::to_string(cause.episodes)},
       {"all", std::to_string(report.episodes.size())},
       {"share", Percent(share)},
       {"meaning", TextOf(cause.name).meaning},
       {"width", Fixed(100 * share, 1)},
       {"example", film.empty() ? text : film + "<p>" + FilmLink(example, pictures) + "</p>"}});
}

// which episodes on a door opened it, as filled and hollow dots
std::string Dots(const DoorIdentity& door, Episodes episodes) {
  std::string dots;
  int opened = 0;
  int all = 0;
  for (const EvaluatedEpisode& episode : episodes) {
    if (episode.door_id != door.id) continue;
    const bool success = episode.outcome == EpisodeOutcome::kOpened;
    dots += success ? "●" : "○";
    opened += success ? 1 : 0;
    ++all;
  }
  if (all == 0) return {};
  return Fill(R"(<br/><span class="dots" aria-hidden="true">{dots}</span> {opened} of {all})",
              {{"dots", dots}, {"opened", std::to_string(opened)}, {"all", std::to_string(all)}});
}

// an id that may be broken behind its underscores
std::string BreakableId(const std::string& id) {
  std::string html;
  for (const char c : Escape(id)) html += c == '_' ? std::string("_<wbr/>") : std::string(1, c);
  return html;
}

std::string DoorTile(const DoorIdentity& door, const ReportPictures& pictures, Episodes episodes) {
  const auto picture = pictures.doors.find(door.id);
  const std::string image = picture == pictures.doors.end()
                                ? ""
                                : Fill(R"(<img src="{uri}" alt="{id}" loading="lazy"/>)",
                                       {{"uri", PngUri(picture->second)}, {"id", Escape(door.id)}});
  return Fill(
      R"(<figure>{image}<figcaption><b>{body}</b> with <b>{handle}</b><br/>{category}, {mechanism}{dots}</figcaption></figure>)",
      {{"image", image},
       {"body", BreakableId(door.body.id)},
       {"handle", BreakableId(door.handle.id)},
       {"category", TitleOf(door.category)},
       {"mechanism",
        door.mechanism == Mechanism::kNone ? "no latch" : std::string(NameOf(door.mechanism))},
       {"dots", Dots(door, episodes)}});
}

// of many doors, those with pictures are enough to look at
std::vector<const DoorIdentity*> DoorsToShow(const std::vector<DoorIdentity>& doors,
                                             const ReportPictures& pictures) {
  std::vector<const DoorIdentity*> shown;
  for (const DoorIdentity& door : doors) {
    if (pictures.doors.contains(door.id)) shown.push_back(&door);
  }
  return shown;
}

std::string CountText(std::size_t shown, std::size_t all) {
  return Plural(all, "door") +
         (shown < all ? ", " + std::to_string(shown) + " of them shown" : "") + ".";
}

std::string TrainingGallery(const EvaluationReport& report, const ReportPictures& pictures) {
  if (report.training_doors.empty()) return {};
  const auto shown = DoorsToShow(report.training_doors, pictures);
  std::string tiles;
  for (const DoorIdentity* door : shown) tiles += DoorTile(*door, pictures, {});
  return Fill(
      R"(<h3>Trained on</h3><p class="soft">{count}{note}</p><div class="tiles small">{tiles}</div>)",
      {{"count", CountText(shown.size(), report.training_doors.size())},
       {"note", shown.empty() ? "" : " Pictures: depth in a training episode, from the shards."},
       {"tiles", tiles}});
}

std::string EpisodeRow(const EvaluatedEpisode& episode, const ReportPictures& pictures) {
  return Fill(
      R"(<tr data-category="{category}" data-outcome="{outcome}"><td class="name">{door}</td><td>{category_title}</td>)"
      R"(<td class="number">{seed}</td><td class="number">{episode}</td><td>{outcome_title}</td><td class="number">{hinge}</td>)"
      R"(<td class="number">{handle}</td><td class="number">{actions}</td><td class="soft">{detail}</td></tr>)",
      {{"category", std::string(NameOf(episode.category))},
       {"outcome", std::string(CauseOf(episode))},
       {"door", Escape(episode.door_id)},
       {"category_title", TitleOf(episode.category)},
       {"seed", std::to_string(episode.seed)},
       {"episode", std::to_string(episode.episode)},
       {"outcome_title", TextOf(CauseOf(episode)).title + FilmLink(episode, pictures)},
       {"hinge", Degrees(episode.peak_hinge_rad)},
       {"handle", Degrees(episode.peak_handle_rad)},
       {"actions", std::to_string(episode.opening_actions)},
       {"detail", Escape(episode.detail)}});
}

std::string Option(std::string_view value, const std::string& title) {
  return Fill(R"(<option value="{value}">{title}</option>)",
              {{"value", std::string(value)}, {"title", title}});
}

std::string Filters(Episodes episodes) {
  std::string categories = Option("", "all categories");
  for (const Category category : CategoriesOf(episodes))
    categories += Option(NameOf(category), TitleOf(category));
  std::string outcomes = Option("", "all outcomes");
  const auto opened = NameOf(EpisodeOutcome::kOpened);
  if (Summarise(episodes).opened.successes > 0) outcomes += Option(opened, TextOf(opened).title);
  for (const FailureCause& cause : CausesOf(episodes))
    outcomes += Option(cause.name, TextOf(cause.name).title);
  return Fill(
      R"(<form class="filters" id="filters" hidden="hidden"><select name="category" aria-label="category">{categories}</select>)"
      R"(<select name="outcome" aria-label="outcome">{outcomes}</select>)"
      R"(<input name="text" type="search" placeholder="door or detail" aria-label="door or detail"/><span class="soft" id="shown"></span></form>)",
      {{"categories", categories}, {"outcomes", outcomes}});
}

std::string Term(const std::string& term, const std::string& value) {
  return value.empty() ? "" : "<dt>" + term + "</dt><dd>" + value + "</dd>";
}

std::string PrivilegesTerm(const std::vector<std::string>& privileges) {
  std::string phrases;
  for (const std::string& privilege : privileges)
    phrases += (phrases.empty() ? "" : "; ") + Escape(privilege);
  return phrases.empty() ? phrases : Term("privileges", phrases);
}

std::string Code(const std::string& text) {
  return text.empty() ? "" : "<code>" + Escape(text) + "</code>";
}

std::string SeedList(Episodes episodes) {
  std::string list;
  for (const std::uint64_t seed : Summarise(episodes).over_seeds.seeds)
    list += (list.empty() ? "" : ", ") + std::to_string(seed);
  return list;
}

}  // namespace

bool IsExpert(const EvaluationReport& report) {
  const ReportProvenance& provenance = report.provenance;
  return provenance.policy == "expert" &&
         provenance.policy_sha256.empty();  // no folder of that name
}

namespace {

// Names of the stages that another policy than a rule of the toolkit plays.
std::vector<std::string> PlayedStages(const EvaluationReport& report) {
  const ReportProvenance& provenance = report.provenance;
  std::vector<std::string> stages;
  const auto plays = [](const std::string& actor) {
    return IsTrained(actor) || actor == kOwnPolicy;
  };
  if (plays(provenance.grasper_sha256)) stages.emplace_back("grasp");
  if (plays(provenance.handler_sha256)) stages.emplace_back("handle");
  if (!IsExpert(report)) stages.emplace_back("opening");
  return stages;
}

std::string Title(const EvaluationReport& report, bool held_out) {
  const std::vector<std::string> stages = PlayedStages(report);
  std::string who = stages.empty()  ? "The rule-based expert"
                    : IsOwn(report) ? "The policy " + Escape(report.provenance.policy) + " for "
                                    : "A trained policy for ";
  for (std::size_t i = 0; i < stages.size(); ++i)
    who += (i == 0 ? "" : i + 1 < stages.size() ? ", " : " and ") + stages[i];
  return who + " on " + Plural(report.doors.size(), "door") +
         (held_out ? " never seen in training" : "");
}

std::string Lead(const EvaluationReport& report, bool held_out) {
  const ReportProvenance& provenance = report.provenance;
  const std::string grasp =
      provenance.grasper_sha256.empty()
          ? "By rules that read the joints from the simulator, a mobile "
            "Franka grasps the handle"
      : provenance.grasper_sha256 == kOwnPolicy ? "A policy of one's own chooses the grasp"
      : IsTrained(provenance.grasper_sha256)
          ? "A trained policy chooses the grasp from a point cloud"
          : "The policy " + Escape(provenance.grasper_sha256) + " chooses the grasp";
  const std::string handle =
      provenance.handler_sha256.empty()         ? "; a rule turns it"
      : provenance.handler_sha256 == kOwnPolicy ? "; a policy of one's own turns it"
      : !IsTrained(provenance.handler_sha256)
          ? "; the policy " + Escape(provenance.handler_sha256) + " turns it"
      : IsSwitchPredicted(provenance) ? "; a trained policy turns it and says when it has"
                                      : "; a trained policy turns it";
  const std::string opening =
      IsExpert(report) ? "; a rule opens the door."
      : IsOwn(report)  ? "; the policy " + Escape(provenance.policy) + " opens the door."
                       : "; a trained policy opens the door from an occluded point cloud and the "
                         "robot's own joints.";
  const std::string all =
      "One trained policy takes hold of the handle, turns it and opens the door.";
  return (DidAll(provenance) ? all : grasp + handle + opening) +
         (held_out ? " No body and no handle of these doors was in a training episode." : "");
}

}  // namespace

std::string HeadlineSection(const EvaluationReport& report, const ReportPictures& pictures) {
  const SuccessSummary summary = Summarise(report.episodes);
  const bool held_out =
      !report.trained_on.empty() && SeenDoors(report.doors, report.trained_on).empty();
  std::string figures =
      Figure(Percent(summary.opened.rate),
             "opened beyond 45°, 95&#160;% interval " + IntervalText(summary.opened), true);
  if (summary.over_seeds.rates.size() > 1) {
    figures +=
        Figure(SpreadText(summary.over_seeds), "mean and standard deviation over " +
                                                   Plural(summary.over_seeds.seeds.size(), "seed"));
  }
  if (!report.reference.empty()) {
    const SuccessRate expert = Summarise(report.reference).opened;
    figures +=
        Figure(Percent(expert.rate), "the expert on the same scenes, " + IntervalText(expert));
  }
  figures += Figure(std::to_string(report.doors.size()),
                    std::string(held_out ? "held-out doors" : "doors") + ", " +
                        Plural(report.episodes.size(), "episode"));
  return Fill(
      R"(<header><div class="over">doorforge evaluation</div><h1>{title}</h1><p class="lead">{lead}</p>)"
      R"(<nav><a href="#success">Success</a><a href="#angle">Door angle</a><a href="#causes">Causes of failure</a>{grasps}<a href="#doors">Doors</a>)"
      R"(<a href="#episodes">Episodes</a><a href="#provenance">How it was made</a></nav>)"
      R"(<div class="figures">{figures}</div>{film}</header>)",
      {{"title", Title(report, held_out)},
       {"lead", Lead(report, held_out)},
       {"grasps", pictures.grasps.empty() ? "" : R"(<a href="#grasps">Grasps</a>)"},
       {"figures", figures},
       {"film", FilmFigure(pictures, EpisodeOutcome::kOpened)}});
}

std::string SuccessSection(const EvaluationReport& report) {
  std::string rows;
  std::string efforts;
  for (const EpisodeGroup& group : GroupsOf(report.episodes)) {
    const std::vector<EvaluatedEpisode> episodes = OfGroup(report.episodes, group);
    rows += SuccessRow(TitleOf(group), episodes, OfGroup(report.reference, group),
                       !group.category.has_value());
    efforts += EffortRow(TitleOf(group), episodes);
  }
  const std::string expert_legend =
      report.reference.empty()
          ? ""
          : R"(<span><svg class="bar" style="width: 12px" viewBox="0 0 12 12"><path class="reference" d="M6 1l5 5l-5 5l-5 -5z"/></svg>expert on the same scenes</span>)";
  return Fill(
      R"(<section id="success"><h2>Success by category</h2><p class="soft">Share of episodes that opened the door beyond 45° with the gripper still on the handle.</p>)"
      R"(<div class="legend"><span><svg viewBox="0 0 34 12"><rect class="fill" y="1" width="34" height="10" rx="2"/></svg>{policy}</span>)"
      R"(<span><svg viewBox="0 0 34 12"><path class="whisker" d="M1 6H33M1 2v8M33 2v8"/></svg>95&#160;% interval</span>{expert_legend}</div>)"
      R"(<div class="scroll"><table><thead><tr><th>category</th><th></th><th class="number">success</th><th class="number">95&#160;% interval</th>)"
      R"(<th class="number">opened</th><th class="number">over seeds</th>{expert_head}</tr></thead><tbody>{rows}</tbody></table></div>)"
      R"(<h3>Handle, time and force</h3><p class="soft">Handle turned: held, turned and unlocked. Time: simulated, median of the episodes that opened. Force: the greatest sum of normal forces between robot and door in one step of an episode.</p>)"
      R"(<div class="scroll"><table><thead><tr><th>category</th><th class="number">handle turned</th><th class="number">time to open</th>)"
      R"(<th class="number">force, median</th><th class="number">most</th></tr></thead><tbody>{efforts}</tbody></table></div></section>)",
      {{"policy", PolicyName(report)},
       {"expert_legend", expert_legend},
       {"expert_head", report.reference.empty() ? "" : R"(<th class="number">expert</th>)"},
       {"rows", rows},
       {"efforts", efforts}});
}

std::string AngleSection(const EvaluationReport& report) {
  std::string rows;
  for (const EpisodeGroup& group : GroupsOf(report.episodes))
    rows += AngleRow(TitleOf(group), OfGroup(report.episodes, group));
  if (!report.reference.empty()) rows += AngleRow("Expert, all", report.reference);
  const std::string expert_legend =
      report.reference.empty()
          ? ""
          : R"(<span><svg viewBox="0 0 34 12"><path class="line reference" d="M1 6H33"/></svg>expert on the same scenes</span>)";
  return Fill(
      R"(<section id="angle"><h2>Success over the door angle</h2><p class="soft">Share of episodes whose door passed an angle at any time, whether or not the gripper still held the handle. Dotted lines and dots: the paper's thresholds of 0.1 rad, 15°, 30° and 45°.</p>)"
      R"(<div class="legend"><span><svg viewBox="0 0 34 12"><path class="line policy" d="M1 6H33"/></svg>{policy}</span>{expert_legend}</div>)"
      R"(<div class="card">{chart}</div><div class="scroll"><table><thead><tr><th>category</th><th class="number">beyond 0.1 rad</th><th class="number">15°</th>)"
      R"(<th class="number">30°</th><th class="number">45°</th></tr></thead><tbody>{rows}</tbody></table></div></section>)",
      {{"policy", PolicyName(report)},
       {"expert_legend", expert_legend},
       {"chart", AngleChart(report.episodes, report.reference)},
       {"rows", rows}});
}

std::string CauseSection(const EvaluationReport& report, const ReportPictures& pictures) {
  const std::vector<FailureCause> causes = CausesOf(report.episodes);
  std::string content = causes.empty() ? "<p>No episode failed.</p>" : "";
  for (const FailureCause& cause : causes) content += Cause(report, pictures, cause);
  return R"(<section id="causes"><h2>Causes of failure</h2>)" + content + "</section>";
}

std::string GraspSection(const ReportPictures& pictures) {
  if (pictures.grasps.empty()) return {};
  std::string figures;
  for (const ReportGrasp& grasp : pictures.grasps) {
    figures += Fill(
        R"(<figure><h3>{category}: {ending}</h3><img src="{uri}" alt="{caption}"/><figcaption>{caption}</figcaption></figure>)",
        {{"category", TitleOf(grasp.category)},
         {"ending", grasp.opened ? "opened" : "failed"},
         {"uri", PngUri(grasp.picture.png)},
         {"caption", Escape(grasp.picture.caption)}});
  }
  return Fill(
      R"(<section id="grasps"><h2>Where it takes hold</h2><p class="soft">Handles coloured by affordance: the angle to which the trained grasper expects a door to open if it is held there, from dark violet (least) to yellow (most), )"
      R"(with a scale below each picture. White ring: the chosen contact. Red: the hand; its arrows say how the fingers close. Of each category the first door that opened and the first that did not.</p>)"
      R"(<div class="two">{figures}</div></section>)",
      {{"figures", figures}});
}

std::string DoorSection(const EvaluationReport& report, const ReportPictures& pictures) {
  std::string tiles;
  const auto shown = DoorsToShow(report.doors, pictures);
  for (const DoorIdentity* door : shown) tiles += DoorTile(*door, pictures, report.episodes);
  const auto seen = SeenDoors(report.doors, report.trained_on);
  std::string note = CountText(shown.size(), report.doors.size()) +
                     " Filled dots are episodes that opened the door, in the order of the seeds.";
  if (!report.trained_on.empty()) {
    note += seen.empty() ? " None of their bodies and handles was trained on."
                         : " The body or the handle of " + Plural(seen.size(), "door") +
                               " was trained on; these numbers do not show generalisation.";
  }
  return Fill(
      R"(<section id="doors"><h2>Doors</h2><h3>Evaluated on</h3><p class="soft">{note}</p><div class="tiles">{tiles}</div>{training}</section>)",
      {{"note", note}, {"tiles", tiles}, {"training", TrainingGallery(report, pictures)}});
}

std::string SightSection(const ReportPictures& pictures) {
  const std::string figures =
      PictureFigure(pictures.scene) + PictureFigure(pictures.depth) + PictureFigure(pictures.cloud);
  if (figures.empty()) return {};
  return R"(<section id="sight"><h2>What the policy sees</h2><div class="three">)" + figures +
         "</div></section>";
}

std::string LossSection(const EvaluationReport& report) {
  std::string charts;
  for (const LossCurve& loss : report.losses) {
    charts += Fill(R"(<figure class="card"><h3>{name}</h3>{chart}</figure>)",
                   {{"name", Escape(loss.name)}, {"chart", LossChart(loss)}});
  }
  if (charts.empty()) return {};
  return R"(<section id="training"><h2>Training</h2><div class="legend"><span><svg viewBox="0 0 34 12"><path class="line training" d="M1 6H33"/></svg>training</span>)"
         R"(<span><svg viewBox="0 0 34 12"><path class="line validation" d="M1 6H33"/></svg>validation</span></div><div class="two">)" +
         charts + "</div></section>";
}

std::string EpisodeSection(const EvaluationReport& report, const ReportPictures& pictures) {
  std::string rows;
  for (const EvaluatedEpisode& episode : report.episodes) rows += EpisodeRow(episode, pictures);
  return Fill(
      R"(<section id="episodes"><h2>Every episode</h2>{filters}<div class="rows"><table><thead><tr><th>door</th><th>category</th><th class="number">seed</th>)"
      R"(<th class="number">episode</th><th>outcome</th><th class="number">door</th><th class="number">handle</th><th class="number">actions</th>)"
      R"(<th>detail</th></tr></thead><tbody id="rows">{rows}</tbody></table></div></section>)",
      {{"filters", Filters(report.episodes)}, {"rows", rows}});
}

std::string ProvenanceSection(const EvaluationReport& report) {
  const ReportProvenance& provenance = report.provenance;
  return Fill(
      R"(<section id="provenance"><h2>How it was made</h2><pre>{command}</pre><dl>{terms}</dl>)"
      R"(<p class="soft">Success: the hinge passes 45° with the gripper on the handle. Intervals: 95&#160;%, by resampling bodies and handles, not episodes, which are not independent. )"
      R"(The same command on the same files gives the same numbers, for any number of threads.</p>)"
      R"(<details><summary>effective configuration</summary><pre>{config}</pre></details></section>)",
      {{"command", Escape(provenance.command)},
       {"terms", Term("code", Code(provenance.code_version)) +
                     Term("policy", Code(provenance.policy)) +
                     Term("policy SHA-256", Code(provenance.policy_sha256)) +
                     Term("data set SHA-256", Code(provenance.dataset_sha256)) +
                     Term("handle policy SHA-256", provenance.handler_sha256.empty()
                                                       ? std::string("none: the rule turns it")
                                                       : Code(provenance.handler_sha256)) +
                     Term("grasp policy SHA-256", provenance.grasper_sha256.empty()
                                                      ? std::string("none: the expert takes hold")
                                                      : Code(provenance.grasper_sha256)) +
                     (provenance.finder_sha256.empty()
                          ? std::string()
                          : Term("handle finder SHA-256", Code(provenance.finder_sha256))) +
                     PrivilegesTerm(provenance.privileges) +
                     Term("configuration SHA-256", Code(Sha256Hex(JsonText(provenance.config)))) +
                     Term("seeds", SeedList(report.episodes))},
       {"config", Escape(JsonText(provenance.config, 2))}});
}

}  // namespace doorforge::internal
