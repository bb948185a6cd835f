// Runs the code that the page holds deflated.
(async () => {
  const text = atob(document.getElementById("code").textContent);
  const bytes = Uint8Array.from(text, (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const code = new Blob([await new Response(stream).arrayBuffer()], { type: "text/javascript" });
  const script = document.createElement("script");
  script.src = URL.createObjectURL(code);
  document.head.append(script);
})();
