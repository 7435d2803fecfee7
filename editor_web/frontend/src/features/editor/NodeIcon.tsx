/** The icon of what can be put into a behavior, as the catalogue names it. */
import {
  IconArrowsSplit2,
  IconBinaryTree2,
  IconBox,
  IconFileImport,
  IconRepeat,
  IconSitemap,
  IconArrowsShuffle,
  IconArrowRight,
  IconGitFork,
  IconQuestionMark,
  IconEqual,
  IconRefresh,
  IconClock,
  IconShieldHalf,
  IconSwitchHorizontal,
} from '@tabler/icons-react'
import { useEditor } from './store'

const ICONS: Record<string, typeof IconBox> = {
  arrow: IconArrowRight,
  box: IconBox,
  clock: IconClock,
  equal: IconEqual,
  fork: IconGitFork,
  loop: IconRepeat,
  question: IconQuestionMark,
  refresh: IconRefresh,
  shield: IconShieldHalf,
  shuffle: IconArrowsShuffle,
  sitemap: IconSitemap,
  split: IconArrowsSplit2,
  switch: IconSwitchHorizontal,
  tree: IconBinaryTree2,
}

export interface NodeIconProps {
  readonly kind: string
  readonly size?: number
  readonly color?: string
}

export function NodeIcon({ kind, size = 16, color = 'currentColor' }: NodeIconProps) {
  const catalogue = useEditor((s) => s.catalogue)
  const name = catalogue?.containers.find((each) => each.kind === kind)?.icon ?? ''
  const Icon = kind === 'behavior' ? IconFileImport : (ICONS[name] ?? IconBox)
  return <Icon size={size} color={color} style={{ flex: 'none' }} aria-hidden />
}
