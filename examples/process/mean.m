% Mean of the newest words in Octave, as a filter of fogbench: protocol 1.
%
%     [filter.process]
%     command = ["octave-cli", "--quiet", "--no-init-file", "./mean.m"]
%     parameters = { taps = 8 }
%
% Print to stderr, as by fprintf (stderr, ...): stdout is for words. In MATLAB, whose stdin and stdout carry
% no bytes, write the words into a file and use [filter.replay].

greeting = jsondecode (fgetl (stdin));
taps = 8;
if (isfield (greeting.parameters, "taps"))
  taps = greeting.parameters.taps;
endif
fputs (stdout, "{\"fogbench_filter\": 1, \"name\": \"mean\", \"version\": \"1\"}\n");
fflush (stdout);

past = zeros (taps - 1, 1);
while (true)
  count = fread (stdin, 1, "uint32", 0, "ieee-le");
  if (isempty (count) || count == 0)
    break;
  endif
  words = fread (stdin, count, "double", 0, "ieee-le");
  [filtered, past] = filter (ones (taps, 1) / taps, 1, words, past);
  fwrite (stdout, count, "uint32", 0, "ieee-le");
  fwrite (stdout, filtered, "double", 0, "ieee-le");
  fflush (stdout);
endwhile
