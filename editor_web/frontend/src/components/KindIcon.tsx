/** The icon of a node, as the server names it: the one place that draws kinds of nodes and groups of states. */
import {
  IconArrowRight,
  IconArrowsExchange,
  IconArrowsShuffle,
  IconArrowsSplit2,
  IconBinaryTree2,
  IconBox,
  IconBraces,
  IconBroadcast,
  IconBuildingFactory2,
  IconCamera,
  IconClock,
  IconCube,
  IconDatabase,
  IconEqual,
  IconFileImport,
  IconFilter,
  IconGitFork,
  IconHandGrab,
  IconHandThreeFingers,
  IconHourglass,
  IconInfinity,
  IconListNumbers,
  IconMap2,
  IconPackage,
  IconQuestionMark,
  IconRefresh,
  IconRepeat,
  IconRepeatOnce,
  IconRoute,
  IconShieldHalf,
  IconSitemap,
  IconSwitchHorizontal,
  IconToggleRight,
} from '@tabler/icons-react'

const ICONS = {
  arrow: IconArrowRight,
  behavior: IconFileImport,
  broadcast: IconBroadcast,
  camera: IconCamera,
  cell: IconBuildingFactory2,
  clock: IconClock,
  equal: IconEqual,
  exchange: IconArrowsExchange,
  filter: IconFilter,
  flow: IconBraces,
  fork: IconGitFork,
  gripper: IconHandGrab,
  hand: IconHandThreeFingers,
  hourglass: IconHourglass,
  list: IconListNumbers,
  loop: IconRepeat,
  once: IconRepeatOnce,
  output: IconToggleRight,
  part: IconPackage,
  path: IconRoute,
  plan: IconMap2,
  question: IconQuestionMark,
  refresh: IconRefresh,
  scene: IconCube,
  shield: IconShieldHalf,
  shuffle: IconArrowsShuffle,
  sitemap: IconSitemap,
  split: IconArrowsSplit2,
  state: IconBox,
  store: IconDatabase,
  switch: IconSwitchHorizontal,
  tree: IconBinaryTree2,
  while: IconInfinity,
}

function isDrawn(icon: string): icon is keyof typeof ICONS {
  return Object.hasOwn(ICONS, icon)
}

export interface KindIconProps {
  /** The name of the icon; an unknown one is drawn as that of a state. */
  readonly icon: string
  /** What it means, where no word of it stands beside. */
  readonly title?: string
  readonly size?: number
}

export function KindIcon({ icon, title, size = 16 }: KindIconProps) {
  const Icon = ICONS[isDrawn(icon) ? icon : 'state']
  const words = title ? { role: 'img', 'aria-label': title, title } : { 'aria-hidden': true }
  return <Icon size={size} color="var(--quiet)" style={{ flex: 'none' }} data-icon={icon} {...words} />
}
