// SPDX-License-Identifier: AGPL-3.0-or-later
// Steps LIBRARY: the motion of tests/windows/steps.c through Palpate.cs, and the same lines of bits.
using System;
using System.Text;
using Palpate;

static class Steps
{
    static void Bits(StringBuilder line, double number)
    {
        line.Append(BitConverter.DoubleToInt64Bits(number).ToString("x16")).Append(' ');
    }

    static void PressFrom(State state, LibraryInfo info, int side)
    {
        int axis = side / 2;
        double sign = side % 2 != 0 ? -1 : 1;
        double[] still = new double[3], position = new double[3], force = new double[3];
        state.Reset();
        for (int i = 0; i < 600; ++i)
        {
            for (int k = 0; k < 3; ++k) position[k] = 0.5 * (info.Low[k] + info.High[k]);
            double reach = 0.6 * (info.High[axis] - info.Low[axis]);
            double depth = 1e-3 * (i < 400 ? i : 400);
            position[axis] += sign * (reach - (depth < reach ? depth : reach));
            position[(axis + 1) % 3] += i < 400 ? 0 : 2e-5 * (i - 400);
            Status status = state.Step(position, still, 1e-3, force);
            Observation seen = state.Observe();
            if (seen.Element < 0) continue;
            StringBuilder line = new StringBuilder();
            line.AppendFormat("{0} {1} {2:x8} {3} ", side, i, (uint)status, seen.Element);
            foreach (double f in force) Bits(line, f);
            Bits(line, seen.Depth);
            Bits(line, seen.Energy);
            Bits(line, seen.Tank);
            Console.WriteLine(line);
        }
    }

    static void Main(string[] words)
    {
        using (Library library = new Library(System.IO.File.ReadAllBytes(words[0])))
        using (State state = new State(library))
            for (int side = 0; side < 6; ++side) PressFrom(state, library.Info, side);
    }
}
