/* A C function as a filter of fogbench: protocol 1, in one header to copy.
 *
 *     static double step(void *state, double word) { ... }
 *     int main(void) { return fogbench_serve("mine", "1", start, step, &state); }
 *
 * `start` (or NULL) is given the greeting, one line of JSON, and may refuse it by anything but 0;
 * fogbench_number() reads a number out of it. `step` makes one word of one word. Print to stderr: stdout is
 * for words. Binary64 in the byte order of the protocol, little-endian; POSIX. Compile with
 * -ffp-contract=off for the same bits on every machine.
 */
#ifndef FOGBENCH_FILTER_H
#define FOGBENCH_FILTER_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FOGBENCH_PROTOCOL 1
#define FOGBENCH_LINE_MAX 65536

/* The number behind a name in the greeting; `otherwise` where there is none. */
static double fogbench_number(const char *greeting, const char *name, double otherwise)
{
    char key[128];
    const char *found;
    snprintf(key, sizeof key, "\"%s\":", name);
    found = strstr(greeting, key);
    return found ? strtod(found + strlen(key), NULL) : otherwise;
}

static int fogbench_serve(const char *name, const char *version,
                          int (*start)(void *state, const char *greeting),
                          double (*step)(void *state, double word), void *state)
{
    static char greeting[FOGBENCH_LINE_MAX];
    /* What is printed by mistake goes to stderr. */
    FILE *words_out = fdopen(dup(STDOUT_FILENO), "wb");
    if (!words_out || dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
        return 1;
    if (!fgets(greeting, sizeof greeting, stdin) ||
        fogbench_number(greeting, "fogbench_filter", 0) != FOGBENCH_PROTOCOL) {
        fprintf(stderr, "this is a filter of protocol %d\n", FOGBENCH_PROTOCOL);
        return 1;
    }
    if (start && start(state, greeting) != 0)
        return 1;
    fprintf(words_out, "{\"fogbench_filter\": %d, \"name\": \"%s\", \"version\": \"%s\"}\n",
            FOGBENCH_PROTOCOL, name, version);
    fflush(words_out);
    for (;;) {
        uint32_t count, word;
        double *words;
        if (fread(&count, sizeof count, 1, stdin) != 1)
            return 1;
        if (count == 0)
            return fclose(words_out) == 0 ? 0 : 1;
        words = malloc(count * sizeof *words);
        if (!words || fread(words, sizeof *words, count, stdin) != count)
            return 1;
        for (word = 0; word < count; word++)
            words[word] = step(state, words[word]);
        fwrite(&count, sizeof count, 1, words_out);
        fwrite(words, sizeof *words, count, words_out);
        fflush(words_out);
        free(words);
    }
}

#endif
