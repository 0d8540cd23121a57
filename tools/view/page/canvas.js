// A view: vtk.js draws into one canvas, we over it into another.
import vtkOpenGLRenderWindow from '@kitware/vtk.js/Rendering/OpenGL/RenderWindow';
import vtkRenderWindow from '@kitware/vtk.js/Rendering/Core/RenderWindow';
import vtkRenderer from '@kitware/vtk.js/Rendering/Core/Renderer';

function element(tag, name, parent) {
  const made = document.createElement(tag);
  made.className = name;
  parent.append(made);
  return made;
}

export class CanvasView {
  constructor(parent, kind, name) {
    this.root = element('div', `view ${kind}`, parent);
    this.root.tabIndex = 0;
    this.root.dataset.view = name;
    this.root.setAttribute('aria-label', name);
    this.stage = element('div', 'stage', this.root);
    this.over = element('canvas', 'over', this.root);
    this.title = element('div', 'name', this.root);
    this.title.textContent = name;
    this.alone = element('button', '', this.root);
    this.alone.type = 'button';
    this.alone.textContent = '⤢';
    this.alone.title = 'This view alone, and back (double click)';
    this.alone.addEventListener('click', () => this.toggleAlone());
    this.root.addEventListener('dblclick', (event) => {
      if (event.target !== this.slider && event.target !== this.alone) this.toggleAlone();
    });

    this.renderer = vtkRenderer.newInstance({ background: [0, 0, 0] });
    this.renderWindow = vtkRenderWindow.newInstance();
    this.renderWindow.addRenderer(this.renderer);
    this.gl = vtkOpenGLRenderWindow.newInstance();
    this.gl.setContainer(this.stage);
    this.renderWindow.addView(this.gl);
    this.width = 0;  // not laid out yet
    this.height = 0;
    this.ratio = 1;
    this.asked = false;
    this.observer = new ResizeObserver(() => this.#resize());
    this.observer.observe(this.root);
  }

  // Another image comes: browsers have few contexts of WebGL to give.
  dispose() {
    this.observer.disconnect();
    this.width = 0;
    this.root.remove();
    this.renderWindow.removeView(this.gl);
    this.gl.delete();
    this.renderWindow.delete();
  }

  toggleAlone() {
    const views = this.root.parentElement;
    const alone = !this.root.classList.contains('alone');
    for (const view of views.children) view.classList.remove('alone');
    this.root.classList.toggle('alone', alone);
    views.classList.toggle('one', alone);
  }

  // In pixels of the page.
  #resize() {
    const { width, height } = this.root.getBoundingClientRect();
    if (width < 1 || height < 1) return;
    this.width = width;
    this.height = height;
    this.ratio = window.devicePixelRatio || 1;
    this.gl.setSize(Math.round(width * this.ratio), Math.round(height * this.ratio));
    this.over.width = Math.round(width * this.ratio);
    this.over.height = Math.round(height * this.ratio);
    this.resized();
    this.draw();
  }
  resized() {}

  // Once before the next frame, however often it is asked for.
  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }
  draw() {
    if (this.width === 0) return;
    this.prepare();
    this.renderWindow.render();
    const context = this.over.getContext('2d');
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    this.drawOver(context);
  }

  // Where in the view an event is.
  at(event) {
    const box = this.root.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }
}
