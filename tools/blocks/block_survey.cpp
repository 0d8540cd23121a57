#include "tools/blocks/block_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/blocks/block_record.h"
#include "tools/cohort/cohort_progress.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

// Ends within so many times the longest task, and within this, tell whether somebody is at work.
constexpr double kRecentTasks = 2;
constexpr double kRecentSeconds = 60;

struct Ended {
  double at, seconds;
};

size_t index(int number) {
  return static_cast<size_t>(number);
}

void count(LevelSurvey& level, const TaskRecord& record) {
  ++level.recorded;
  level.restless += record.converged ? 0 : 1;
  level.bricks_read += record.bricks_read;
  level.peak_bytes = std::max(level.peak_bytes, record.peak_bytes);
  level.seconds += record.seconds;
  level.longest_seconds = std::max(level.longest_seconds, record.seconds);
}

// A level has as many blocks as the one above, and `reduction` squared times the vertices.
std::vector<double> task_seconds_of(const std::vector<LevelSurvey>& levels, double reduction) {
  std::vector<double> seconds(levels.size(), 0);
  for (size_t level = 0; level < levels.size(); ++level) {
    for (size_t away = 0; away < levels.size() && seconds[level] == 0; ++away) {
      double ratio = 1;  // of vertices
      for (size_t i = 0; i < away; ++i) ratio *= reduction * reduction;
      const auto measured = [&](size_t other, double factor) {
        if (other >= levels.size() || levels[other].recorded == 0) return;
        seconds[level] = std::max(levels[other].seconds, 1e-3) /
                         static_cast<double>(levels[other].recorded) * factor;
      };
      if (level >= away) measured(level - away, 1 / ratio);
      measured(level + away, ratio);  // what a coarser one tells is nearer to what is left
    }
  }
  return seconds;
}

double pace_of(const std::vector<Ended>& ended, double now) {
  double longest = 0, first = now, sum = 0;
  for (const Ended& task : ended) longest = std::max(longest, task.seconds);
  const double window = std::max(kRecentSeconds, kRecentTasks * longest);
  for (const Ended& task : ended) {
    if (task.at <= now - window) continue;
    first = std::min(first, task.at - task.seconds);
    sum += task.seconds;
  }
  return sum / std::max(1.0, std::min(window, now - first));
}

// Steps wait for each other, so that none takes less than one task does.
double seconds_left(const BlockSurvey& survey, const BlockPlan& plan) {
  double all = 0;
  for (int step = 0; step < plan.steps(); ++step) {
    const size_t left = survey.steps[index(step)].left.size();
    const double one = survey.task_seconds[index(plan.level_of(step))];
    if (left == 0) continue;
    if (one == 0) return -1;
    const double sum = static_cast<double>(left) * one;
    all += survey.pace > 0 ? std::max(one, sum / survey.pace) : sum;
  }
  return all;
}

template <typename... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

BlockSurvey survey_of(const std::string& folder, const BlockPlan& plan, std::time_t now) {
  BlockSurvey survey;
  survey.steps.resize(index(plan.steps()));
  survey.levels.resize(index(plan.from_level) + 1);
  std::vector<Ended> ended;
  for (int step = 0; step < plan.steps(); ++step) {
    StepSurvey& own = survey.steps[index(step)];
    for (const int64_t block : plan.grid.blocks_of_colour(step % BlockGrid::kColours)) {
      const std::string path = block_path(folder, plan, step, plan.grid.block_at(block));
      ++own.tasks;
      if (!std::filesystem::exists(path)) {
        own.left.push_back(block);
      } else if (const auto record = read_record(path)) {
        count(survey.levels[index(plan.level_of(step))], *record);
        ended.push_back({record->ended, record->seconds});
      }
    }
    survey.tasks += own.tasks;
    survey.left += static_cast<int64_t>(own.left.size());
  }
  survey.task_seconds = task_seconds_of(survey.levels, plan.parameters.reduction);
  survey.pace = pace_of(ended, static_cast<double>(now));
  survey.seconds_left = seconds_left(survey, plan);
  return survey;
}

std::string status_text(const BlockSurvey& survey, const BlockPlan& plan, std::time_t now) {
  std::string text;
  for (int step = 0; step < plan.steps(); ++step) {
    const StepSurvey& own = survey.steps[index(step)];
    if (own.tasks == 0) continue;
    const auto left = static_cast<int64_t>(own.left.size());
    text += line("step %-3d level %d  %6lld done %6lld left\n", step, plan.level_of(step),
                 static_cast<long long>(own.tasks - left), static_cast<long long>(left));
  }
  for (int level = plan.from_level; level >= 0; --level) {
    const LevelSurvey& own = survey.levels[index(level)];
    if (own.recorded == 0) continue;
    text += line("level %d  a task %.1f s on average, %.1f s at most, %.0f MiB; %lld bricks read\n",
                 level, own.seconds / static_cast<double>(own.recorded), own.longest_seconds,
                 static_cast<double>(own.peak_bytes) / (1024 * 1024),
                 static_cast<long long>(own.bricks_read));
    if (own.restless > 0) {
      text +=
          line("level %d  has not converged in %lld of %lld tasks; more --max-iterations\n", level,
               static_cast<long long>(own.restless), static_cast<long long>(own.recorded));
    }
  }
  text += line("done     %lld\nleft     %lld\n", static_cast<long long>(survey.tasks - survey.left),
               static_cast<long long>(survey.left));
  if (survey.left == 0 || survey.seconds_left < 0) return text;
  const std::string duration = duration_text(survey.seconds_left);
  if (survey.pace > 0) {
    return text + "end      " + clock_text(static_cast<double>(now) + survey.seconds_left) +
           ", in about " + duration + " as it goes now\n";
  }
  return text + "end      nothing ends at present; one task after the other takes about " +
         duration + "\n";
}

std::string status_json(const BlockSurvey& survey, const BlockPlan& plan, std::time_t now) {
  Json json = {{"tasks", survey.tasks},   {"done", survey.tasks - survey.left},
               {"left", survey.left},     {"pace", survey.pace},
               {"seconds_left", nullptr}, {"expected_end", nullptr},
               {"levels", Json::array()}, {"steps", Json::array()}};
  if (survey.seconds_left >= 0) json["seconds_left"] = survey.seconds_left;
  if (survey.left > 0 && survey.seconds_left >= 0 && survey.pace > 0) {
    json["expected_end"] = static_cast<int64_t>(static_cast<double>(now) + survey.seconds_left);
  }
  for (int level = plan.from_level; level >= 0; --level) {
    const LevelSurvey& own = survey.levels[index(level)];
    json["levels"].push_back({{"level", level},
                              {"recorded", own.recorded},
                              {"not_converged", own.restless},
                              {"seconds", own.seconds},
                              {"longest_seconds", own.longest_seconds},
                              {"task_seconds", survey.task_seconds[index(level)]},
                              {"bricks_read", own.bricks_read},
                              {"peak_bytes", own.peak_bytes}});
  }
  for (int step = 0; step < plan.steps(); ++step) {
    const StepSurvey& own = survey.steps[index(step)];
    json["steps"].push_back({{"step", step},
                             {"level", plan.level_of(step)},
                             {"tasks", own.tasks},
                             {"done", own.tasks - static_cast<int64_t>(own.left.size())},
                             {"blocks_left", own.left}});
  }
  return json.dump(2) + "\n";
}

}  // namespace plc::tools
