// Light and dark: what the system prefers, until the reader says otherwise.

export type Theme = 'light' | 'dark';

const sun = '<svg viewBox="0 0 20 20" width="16" height="16"><circle cx="10" cy="10" r="4"/><g stroke="currentColor" stroke-width="1.6" stroke-linecap="round">' +
  '<path d="M10 1v2.2M10 16.8V19M1 10h2.2M16.8 10H19M3.6 3.6l1.6 1.6M14.8 14.8l1.6 1.6M3.6 16.4l1.6-1.6M14.8 5.2l1.6-1.6"/></g></svg>';
const moon = '<svg viewBox="0 0 20 20" width="16" height="16"><path d="M16.8 12.6A7.3 7.3 0 0 1 7.4 3.2a7.3 7.3 0 1 0 9.4 9.4z"/></svg>';

export class ThemeSwitch {
  private chosen?: Theme;
  private readonly system = window.matchMedia('(prefers-color-scheme: dark)');

  constructor(button: HTMLElement, start: Theme | undefined, private readonly changed: () => void) {
    this.chosen = start;
    this.apply(button);
    this.system.addEventListener('change', () => {
      this.apply(button);
      changed();
    });
    button.addEventListener('click', () => {
      this.chosen = this.theme === 'dark' ? 'light' : 'dark';
      this.apply(button);
      this.changed();
    });
  }

  get theme(): Theme {
    return this.chosen ?? (this.system.matches ? 'dark' : 'light');
  }

  private apply(button: HTMLElement): void {
    document.documentElement.dataset.theme = this.theme;
    button.innerHTML = this.theme === 'dark' ? sun : moon;
  }
}

/** Value of a custom property of the page, e.g. colour('--ink'). */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
