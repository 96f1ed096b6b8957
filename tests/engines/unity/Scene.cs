// SPDX-License-Identifier: AGPL-3.0-or-later
// Scene FOLDER: PalpateBody as Unity would run it, on plate.plib and plate.pdef of the folder: the plate z = 0 of 8 cm with
// f = 17000 z^2 along its normal. Prints nothing and ends with 0 where all is as it must be.
using System;
using System.Reflection;
using System.Threading;
using Palpate;
using UnityEngine;

static class Scene
{
    const float Depth = 0.002f;

    static void Require(bool holds, string what)
    {
        if (!holds) throw new Exception("Scene: " + what);
    }

    /// Unity calls what is named so, private or not.
    static void Send(PalpateBody body, string message)
    {
        typeof(PalpateBody).GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(body, null);
    }

    /// A body that counts its force steps.
    class Counted : PalpateBody
    {
        int steps;
        protected override void Command(double[] force) { Interlocked.Increment(ref steps); }

        /// Until a step has begun and ended since this call.
        public void AwaitStep()
        {
            int before = Thread.VolatileRead(ref steps);
            for (int i = 0; i < 10000 && Thread.VolatileRead(ref steps) < before + 2; ++i) Thread.Sleep(1);
            Require(Thread.VolatileRead(ref steps) >= before + 2, "the force thread makes no steps");
        }
    }

    static Counted BodyOf(string skin)
    {
        Counted body = new Counted { LibraryFile = "plate.plib", SkinFile = skin, ToolTip = new Transform() };
        body.transform.position = new Vector3(0.1f, 0.2f, 0.3f);
        Place(body, -0.001f);
        Send(body, "Start");
        body.AwaitStep();  // outside: a contact begins where the tip goes in
        return body;
    }

    /// The tip over the middle of the plate, which lies level in Unity, as deep as this.
    static void Place(PalpateBody body, float depth)
    {
        body.ToolTip.position = new Vector3(0.14f, 0.2f - depth, 0.34f);
    }

    static float Height(Vector3 a, Vector3 b, Vector3 c)  // of the normal of a triangle that Unity draws: clockwise is the front
    {
        return (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
    }

    static void Press(Counted body)
    {
        for (int i = 0; i < 12; ++i)  // depths count from the first step inside: hardly inside first
        {
            Place(body, i < 2 ? 2e-7f : Depth * Math.Min(1, (i - 1) / 10f));
            Send(body, "Update");
            body.AwaitStep();
        }
        Send(body, "Update");
        float expected = 17000 * Depth * Depth;
        Require(Math.Abs(body.Force.y / expected - 1) < 1e-3, "the force is " + body.Force.y + " N upwards, not " + expected);
        Require(Math.Abs(body.Force.x) + Math.Abs(body.Force.z) < 1e-6, "there is a force along the plate");
    }

    static void Main(string[] words)
    {
        Application.streamingAssetsPath = words[0];
        Counted rigid = BodyOf("");
        Press(rigid);
        Vector3[] still = rigid.GetComponent<MeshFilter>().mesh.vertices;
        int[] corners = rigid.GetComponent<MeshFilter>().mesh.triangles;
        foreach (Vector3 x in still) Require(x.y == 0, "the response surface moved");
        for (int i = 0; i < corners.Length; i += 3)
            Require(Height(still[corners[i]], still[corners[i + 1]], still[corners[i + 2]]) > 0, "a triangle faces down");
        Send(rigid, "OnDestroy");

        Counted soft = BodyOf("plate.pdef");
        Press(soft);
        float lowest = 0;
        foreach (Vector3 x in soft.GetComponent<MeshFilter>().mesh.vertices) lowest = Math.Min(lowest, x.y);
        // The skin under the tip goes as deep as the tip: u(c) . n = z.
        Require(Math.Abs(lowest + Depth) < 1e-5f, "the skin goes to " + lowest + " m");
        Send(soft, "OnDestroy");

        PalpateBody lost = new PalpateBody { LibraryFile = "none.plib" };
        try
        {
            Send(lost, "Start");
            Require(false, "a missing library was accepted");
        }
        catch (TargetInvocationException thrown)
        {
            Require(thrown.InnerException is PalpateException && thrown.InnerException.Message.Contains("none.plib"),
                    "of a missing library it says " + thrown.InnerException.Message);
        }
        Send(lost, "OnDestroy");
    }
}
