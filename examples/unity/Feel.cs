// SPDX-License-Identifier: Apache-2.0
// mcs -unsafe Feel.cs Palpate.cs && mono Feel.exe library.plib 1 0 0
// A tip goes to the middle of the body from the side that is given, at 0.1 m/s, until it is 3 mm deep: feel.c in C#.
using System;
using System.Globalization;
using Palpate;

static class Feel
{
    static int Main(string[] words)
    {
        if (words.Length < 4)
        {
            Console.Error.WriteLine("feel: give LIBRARY X Y Z");
            return 1;
        }
        try
        {
            using (Library library = new Library(words[0]))
            using (State state = new State(library))
                Press(library.Info, state, words);
            return 0;
        }
        catch (PalpateException error)
        {
            Console.Error.WriteLine("feel: " + error.Message);
            return 1;
        }
    }

    static void Press(LibraryInfo box, State state, string[] words)
    {
        double[] at = new double[3], v = new double[3], force = new double[3];
        for (int k = 0; k < 3; ++k) v[k] = -0.1 * double.Parse(words[1 + k], CultureInfo.InvariantCulture);
        double depth = 0;
        for (int i = -2000; i < 2000 && depth < 0.003; ++i)  // your force loop, 1 kHz
        {
            for (int k = 0; k < 3; ++k) at[k] = (box.Low[k] + box.High[k]) / 2 + 1e-3 * i * v[k];
            state.Step(at, v, 1e-3, force);
            depth = state.Observe().Depth;
        }
        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "({0:F4}, {1:F4}, {2:F4}) N, {3:F3} mm deep",
                                        force[0], force[1], force[2], 1e3 * depth));
    }
}
