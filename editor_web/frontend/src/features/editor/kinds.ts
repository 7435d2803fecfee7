/** Icons and colours of what can be put into a behavior. */
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

const ICONS: Record<string, typeof IconBox> = {
  state: IconBox,
  machine: IconSitemap,
  priority: IconArrowsShuffle,
  concurrency: IconArrowsSplit2,
  behavior: IconFileImport,
  tree: IconBinaryTree2,
  foreach: IconRepeat,
  sequence: IconArrowRight,
  selector: IconQuestionMark,
  parallel: IconEqual,
  inverter: IconSwitchHorizontal,
  repeat: IconRepeat,
  retry: IconRefresh,
  timeout: IconClock,
  cooldown: IconClock,
  guard: IconShieldHalf,
  if_then_else: IconGitFork,
  while_do_else: IconGitFork,
}

export function iconOf(kind: string): typeof IconBox {
  return ICONS[kind] ?? IconBox
}
