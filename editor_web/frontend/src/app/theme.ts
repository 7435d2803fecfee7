/** The look of the components: accent and greys of `styles/tokens.css`, spaces that suit a tool, the same in both schemes. */
import { Anchor, createTheme, rem, type MantineColorsTuple } from '@mantine/core'
import tabs from '../components/tabs.module.css'

/** The ten steps of a colour of the tokens. */
function steps(name: string): MantineColorsTuple {
  const step = (index: number) => `var(--${name}-${index})`
  return [step(0), step(1), step(2), step(3), step(4), step(5), step(6), step(7), step(8), step(9)]
}

/** The components' greys in the dark, from text to ground: those of the page. */
const DARK: MantineColorsTuple = [
  'var(--text)',
  'var(--text)',
  'var(--quiet)',
  'var(--edge)',
  'var(--line-strong)',
  'var(--line)',
  'var(--surface)',
  'var(--surface)',
  'var(--canvas)',
  'var(--ground)',
]

export const theme = createTheme({
  colors: { accent: steps('accent'), dark: DARK },
  primaryColor: 'accent',
  primaryShade: { light: 7, dark: 6 },
  fontFamily: "'Inter Variable', system-ui, sans-serif",
  fontFamilyMonospace: "ui-monospace, 'Cascadia Mono', 'JetBrains Mono', Menlo, Consolas, 'DejaVu Sans Mono', monospace",
  defaultRadius: 'md',
  cursorType: 'pointer',
  respectReducedMotion: true,
  // A link in a text is known by its line, not by its colour alone.
  components: {
    Anchor: Anchor.extend({ defaultProps: { underline: 'always', c: 'var(--accent)' } }),
    // By its name: no page has tabs at first.
    Tabs: { classNames: { root: tabs.root, list: tabs.list, tab: tabs.tab, panel: tabs.panel } },
  },
  // Narrower than the kit's own: panels stand close together here. 4, 6 and 8 px of a 16 px page.
  spacing: { '4xs': rem(4), '3xs': rem(6), '2xs': rem(8) },
})
