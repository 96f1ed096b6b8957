// SPDX-License-Identifier: Apache-2.0
// A soft body under a tool. Put it on an empty object, name a .plib of StreamingAssets and the transform of the tool tip.
// Without a device the tool is a transform that the scene moves. With one, override Tool() and Command(): both are called by
// the force thread, at Rate.
using System;
using System.Diagnostics;
using System.IO;
using System.Threading;
using UnityEngine;

namespace Palpate
{
    [RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
    public class PalpateBody : MonoBehaviour
    {
        public string LibraryFile = "gel.plib";
        public string SkinFile = "";  // a deformation.pdef of the library; empty: the response surface, which stays as it is
        public Transform ToolTip;
        public double Rate = 1000;  // Hz

        Library library;
        State state;
        Skin skin;
        Mesh mesh;
        double[] positions;
        Vector3[] vertices;
        Thread loop;
        volatile bool running;
        string failure;

        readonly object gate = new object();  // held for the copy of a few numbers
        readonly double[] tip = new double[3], tipVelocity = new double[3], lastForce = new double[3];

        /// Unity is left-handed with y up, the library right-handed: y and z change places.
        public static Vector3 ToUnity(double x, double y, double z) { return new Vector3((float)x, (float)z, (float)y); }

        /// The last force on the tool, N, in the frame of this object.
        public Vector3 Force
        {
            get { lock (gate) return ToUnity(lastForce[0], lastForce[1], lastForce[2]); }
        }

        void Start()
        {
            library = new Library(Path.Combine(Application.streamingAssetsPath, LibraryFile));
            state = new State(library);
            if (SkinFile != "") skin = new Skin(library, Path.Combine(Application.streamingAssetsPath, SkinFile));
            MakeMesh();
            ReadTip(0);
            running = true;
            loop = new Thread(Run) { IsBackground = true, Priority = System.Threading.ThreadPriority.Highest };
            loop.Start();
        }

        void MakeMesh()
        {
            positions = skin == null ? library.Vertices() : new double[3 * skin.Info.Vertices];
            if (skin != null) skin.Deform(state, positions);
            vertices = new Vector3[positions.Length / 3];
            int[] triangles = skin == null ? library.Triangles() : skin.Triangles();
            for (int i = 0; i < triangles.Length; i += 3)  // the mirrored frame turns the triangles over
            {
                int corner = triangles[i + 1];
                triangles[i + 1] = triangles[i + 2];
                triangles[i + 2] = corner;
            }
            mesh = new Mesh { indexFormat = UnityEngine.Rendering.IndexFormat.UInt32 };
            mesh.MarkDynamic();
            ShowVertices();
            mesh.triangles = triangles;
            mesh.RecalculateNormals();
            GetComponent<MeshFilter>().mesh = mesh;
        }

        void ShowVertices()
        {
            for (int i = 0; i < vertices.Length; ++i)
                vertices[i] = ToUnity(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
            mesh.vertices = vertices;
        }

        /// The main thread: the tool of the scene to the force thread, the skin of the force thread to the scene.
        void Update()
        {
            if (failure != null) throw new PalpateException("the force thread ended: " + failure);
            ReadTip(Time.deltaTime);
            if (skin == null) return;
            skin.Deform(state, positions);  // does not delay the force thread
            ShowVertices();
            mesh.RecalculateNormals();
            mesh.RecalculateBounds();
        }

        void ReadTip(float elapsed)
        {
            if (ToolTip == null) return;
            Vector3 local = transform.InverseTransformPoint(ToolTip.position);
            double[] now = { local.x, local.z, local.y };
            lock (gate)
            {
                for (int k = 0; k < 3; ++k)
                {
                    tipVelocity[k] = elapsed > 0 ? (now[k] - tip[k]) / elapsed : 0;
                    tip[k] = now[k];
                }
            }
        }

        /// Position (m) and velocity (m/s) of the tip in the frame of the library. Of the force thread.
        protected virtual void Tool(double[] position, double[] velocity)
        {
            lock (gate)
            {
                Array.Copy(tip, position, 3);
                Array.Copy(tipVelocity, velocity, 3);
            }
        }

        /// The force on the tool, N, in the frame of the library. Of the force thread.
        protected virtual void Command(double[] force) { }

        void Run()
        {
            try
            {
                double[] position = new double[3], velocity = new double[3], force = new double[3];
                Stopwatch clock = Stopwatch.StartNew();
                double last = -1 / Rate;
                while (running)
                {
                    double now = clock.Elapsed.TotalSeconds;
                    if (now - last < 1 / Rate)
                    {
                        Thread.Yield();
                        continue;
                    }
                    Tool(position, velocity);
                    state.Step(position, velocity, now - last, force);
                    last = now;
                    lock (gate) Array.Copy(force, lastForce, 3);
                    Command(force);
                }
            }
            catch (Exception error)
            {
                failure = error.Message;
            }
        }

        void OnDestroy()
        {
            running = false;
            if (loop != null) loop.Join();
            if (skin != null) skin.Dispose();
            if (state != null) state.Dispose();
            if (library != null) library.Dispose();
        }
    }
}
