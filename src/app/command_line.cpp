#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <sstream>

#include "app/launch.hpp"
#include "app/ranks.hpp"
#include "app/standard_streams.hpp"
#include "app/verbs.hpp"
#include "karcher/version.hpp"

namespace karcher::app {
namespace {

void reading_options(CLI::App& verb, std::filesystem::path& file, ReadOptions& read) {
  verb.add_option("FILE", file, "problem file")->required();
  verb.add_option("--set", read.overrides, "override a key: --set parameters.L=2 --set energies.0.thickness=0.1")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
}

void rank_option(CLI::App& verb, int& ranks) {
  verb.add_option("-n,--ranks", ranks, "number of MPI ranks; they are started here, unless mpirun or srun has done so")
      ->type_name("RANKS")
      ->check(CLI::Range(1, 100000));
}

/// The exit code of a verb, unless what it is for could not be printed.
int with_output(int code, bool needed) {
  const std::string failure = output_failure();
  if (failure.empty()) return code;
  fmt::print(stderr, "{}: standard output cannot be written: {}.{}\n", needed ? "error" : "warning", failure,
             needed ? "" : " The results are not touched by that.");
  return needed && code == 0 ? 3 : code;
}

}  // namespace

int command_line(int argc, char** argv) {
  CLI::App app("Geometric finite elements: minimisers among maps into manifolds, from one text file.", "karcher");
  app.require_subcommand(0, 1);
  app.set_help_all_flag("--help-all", "help of all verbs");
  app.set_version_flag("--version", std::string(version_string));
  int ranks = 0;          // as many as there are
  bool prints = true;     // is standard output what the verb is for?
  bool computes = false;  // does it need MPI and the BLAS?
  std::function<int()> action;

  const auto computing = [&](const std::function<int()>& verb) {
    action = [&ranks, verb] { return on_ranks(ranks, verb); };
    computes = true;
  };

  RunOptions run_options;
  CLI::App& run_verb = *app.add_subcommand("run", "solve a problem and write its results");
  reading_options(run_verb, run_options.file, run_options.read);
  rank_option(run_verb, ranks);
  run_verb.add_option("-o,--output", run_options.read.output, "directory of results, instead of the file's")->type_name("DIR");
  run_verb.add_flag("-q,--quiet", run_options.quiet, "print errors only");
  run_verb.add_flag("--resume", run_options.resume, "go on after the last finished load step of the results");
  run_verb.callback([&] {
    computing([&] { return run(run_options); });
    prints = false;
  });

  EvaluateOptions evaluate_options;
  CLI::App& evaluate_verb = *app.add_subcommand("evaluate", "energies and norm of the gradient at the initial configuration, without solving");
  reading_options(evaluate_verb, evaluate_options.file, evaluate_options.read);
  rank_option(evaluate_verb, ranks);
  evaluate_verb.add_flag("--json", evaluate_options.json, "print JSON, nothing else");
  evaluate_verb.callback([&] { computing([&] { return evaluate(evaluate_options); }); });

  ConvergeOptions converge_options;
  CLI::App& converge_verb = *app.add_subcommand("converge", "solve on refined meshes; errors against [exact] or the finest level, and their orders");
  reading_options(converge_verb, converge_options.file, converge_options.read);
  rank_option(converge_verb, ranks);
  converge_verb.add_option("--levels", converge_options.levels, "number of refinements")->check(CLI::Range(0, 20))->capture_default_str();
  converge_verb.add_option("--start", converge_options.start, "from the coarser solution, or from the initial values of the file")
      ->check(CLI::IsMember({"prolonged", "initial"}))
      ->capture_default_str();
  converge_verb.add_option("-o,--output", converge_options.read.output, "directory for convergence.csv and .json, instead of the file's")
      ->type_name("DIR");
  converge_verb.add_flag("--json", converge_options.json, "print JSON, nothing else");
  converge_verb.add_flag("-q,--quiet", converge_options.quiet, "print errors only");
  converge_verb.callback([&] {
    computing([&] { return converge(converge_options); });
    prints = converge_options.json;
  });

  CheckOptions check_options;
  CLI::App& check_verb = *app.add_subcommand("check", "read and resolve everything, and print what is there");
  reading_options(check_verb, check_options.file, check_options.read);
  check_verb.add_flag("--derivatives", check_options.derivatives, "compare gradient and Hessian of every term with differences of its energy");
  check_verb.add_flag("--objectivity", check_options.objectivity, "compare the energies before and after rigid motions");
  check_verb.callback([&] { computing([&] { return check(check_options); }); });

  ViewOptions view_options;
  std::vector<double> direction;
  std::vector<std::string> shown;
  CLI::App& view_verb = *app.add_subcommand("view", "(re)make the page of a directory of results, and a picture of it");
  view_verb.add_option("DIR", view_options.directory, "directory of results")->required();
  view_verb.add_option("--png", view_options.png, "make a picture, by the Chromium of this machine")->type_name("FILE");
  view_verb.add_option("--view", direction, "direction from the shape to the eye, as 1,-1,0.5")->delimiter(',')->type_name("X,Y,Z");
  view_verb.add_option("--field", view_options.field, "colour by: energy, displacement, the name of a field, ..., none")->type_name("NAME");
  view_verb.add_option("--step", view_options.step, "load step; 0 is the initial configuration")->type_name("K");
  view_verb.add_option("--width", view_options.width, "of the picture, in pixels")->capture_default_str();
  view_verb.add_option("--height", view_options.height, "of the picture, in pixels")->capture_default_str();
  view_verb.add_flag("--dark", view_options.dark, "on dark ground");
  view_verb.add_option("--show", shown, "a setting of the page: edges=0, map=cividis, scale=10, clip=x, \"glyphs=directors of Q\", up=0,1,0, ...")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  view_verb.callback([&] {
    action = [&] {
      if (!direction.empty() && direction.size() != 3) throw InputError("--view takes three numbers, as 1,-1,0.5.");
      if (!direction.empty()) view_options.view = {direction[0], direction[1], direction[2]};
      for (const std::string& s : shown) {
        const std::size_t equals = s.find('=');
        if (equals == std::string::npos) throw InputError("--show takes KEY=VALUE, as edges=0; \"" + s + "\" has no =.");
        view_options.settings.emplace_back(s.substr(0, equals), s.substr(equals + 1));
      }
      return view(view_options);
    };
  });

  std::string name, example = "template";
  CLI::App& new_verb = *app.add_subcommand("new", "start from a template with comments, or from a worked example");
  new_verb.add_option("NAME", name, "directory to be made")->required();
  new_verb.add_option("--from", example, "a worked example instead of the template: karcher list examples")->type_name("EXAMPLE");
  new_verb.callback([&] { action = [&] { return make_new(name, example); }; });

  std::string what;
  CLI::App& list_verb = *app.add_subcommand("list", "what there is: manifolds, energies, loads, meshes, examples");
  list_verb.add_option("WHAT", what, "manifolds, energies, loads, meshes or examples; all of them if not given");
  list_verb.callback([&] { action = [&] { return list(what); }; });

  std::string key;
  bool as_markdown = false;
  CLI::App& doc_verb = *app.add_subcommand("doc", "explain a section or a key of the problem file");
  doc_verb.add_option("KEY", key, "solver, solver.method, mesh.generate, energies.cosserat-shell, ..., or a word that is looked for in all of them");
  doc_verb.add_flag("--markdown", as_markdown, "the keys of a section as a table in Markdown");
  doc_verb.callback([&] { action = [&] { return doc(key, as_markdown); }; });

  CLI::App& version_verb = *app.add_subcommand("version", "print the version");
  version_verb.callback([&] { action = [] { return version(); }; });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = app.exit(error, out, err);
    fmt::print("{}", out.str());
    fmt::print(stderr, "{}", err.str());
    return with_output(code == 0 ? 0 : 2, true);
  }
  if (!action) {
    fmt::print(stderr, "{}", app.help());
    return 2;
  }
  if (computes) use_one_blas_thread(argv);
  const std::optional<int> code = launch_ranks(ranks, argc, argv);
  return with_output(code ? *code : action(), prints);
}

}  // namespace karcher::app
