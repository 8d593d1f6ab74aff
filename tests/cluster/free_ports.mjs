// free_ports.mjs COUNT: prints COUNT ports that were free on 127.0.0.1, on one line. Another
// process can take them before they are used.
import {once} from "node:events";
import {createServer} from "node:net";

// All are open at the same time, so that the ports differ.
const servers = Array.from({length: Number(process.argv[2])}, () =>
  createServer().listen(0, "127.0.0.1"),
);
await Promise.all(servers.map((server) => once(server, "listening")));
console.log(servers.map((server) => server.address().port).join(" "));
for (const server of servers) server.close();
